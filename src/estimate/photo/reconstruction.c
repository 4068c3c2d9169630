/* SPDX-License-Identifier: MIT */
#include "estimate/photo/reconstruction.h"

#include "base/number.h"
#include "estimate/light/found_light.h"
#include "estimate/light/relight_env.h"

static status render_found(const reconstruction *r, img *out)
{
    status s = img_new(out, r->mask->width, r->mask->height, 3);
    return s == OK ? found_light_add(r->maps, r->light, &r->estimated->visibility, out) : s;
}

static status render_flash(const reconstruction *r, img *out)
{
    status s = surface_resize_indirect(&r->estimated->indirect, r->estimated_mask, r->mask, out);
    if (s != OK) return s;
    for (size_t i = 0; i < img_value_count(out); i++)
        if (out->data[i] != 0) out->data[i] *= r->mask->data[i / 3];
    surface_add_light(r->maps, vec3_make(0, 0, 0), out);
    if (r->in_environment) {
        const float(*sh)[3] = (const float(*)[3])r->estimated->environment;
        surface_add_ambient(r->maps, sh, out);
        surface_add_ambient_highlights(r->maps, sh, out);
    }
    return OK;
}

status reconstruction_render(const reconstruction *r, img *out)
{
    status s = r->light->known ? render_found(r, out) : render_flash(r, out);
    for (size_t i = 0; s == OK && i < img_value_count(out); i++)
        if (out->data[i] != 0) out->data[i] = clamp(out->data[i] / r->white, 0, 1);
    return s;
}
