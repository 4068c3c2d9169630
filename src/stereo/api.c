/* SPDX-License-Identifier: MIT */
/* What stands behind include/merlin/stereo.h. */
#include "merlin/stereo.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>

#include "base/api_needs.h"
#include "merlin/merlin.h"
#include "mesh/write/mesh_write.h"
#include "stereo/fit/albedo_scale.h"
#include "stereo/methods/place_lights.h"
#include "stereo/methods/solve.h"

static_assert((int)MERLIN_DISTANT_LIGHTS == (int)PST_DISTANT && (int)MERLIN_NEAR_LIGHTS == (int)PST_NEAR &&
                  (int)MERLIN_UNKNOWN_LIGHTS == (int)PST_UNKNOWN_LIGHT,
              "the public lightings are the inside's");
static_assert((int)MERLIN_STEREO_AUTO == (int)PST_AUTO && (int)MERLIN_STEREO_LS == (int)PST_LS &&
                  (int)MERLIN_STEREO_ROBUST == (int)PST_ROBUST && (int)MERLIN_STEREO_NEAR == (int)PST_NEAR_LIGHTS &&
                  (int)MERLIN_STEREO_SEMI == (int)PST_SEMI && (int)MERLIN_STEREO_UNCALIBRATED == (int)PST_UNCALIBRATED,
              "the public methods are the inside's");

struct merlin_capture {
    pst_capture inside;
    float field_of_view;
};

/* ---- pictures and lights ---- */

static status check_camera(float field_of_view, float distance)
{
    if (!(field_of_view >= 0 && field_of_view <= 170))
        return fail(MERLIN_WRONG_USE, "a capture's field of view is 0 (not known) to 170 degrees, not %g",
                    (double)field_of_view);
    if (!(distance >= 0 && isfinite(distance)))
        return fail(MERLIN_WRONG_USE, "a capture's distance is 0 (not known) or above, not %g", (double)distance);
    return OK;
}

merlin_status merlin_capture_read(const char *folder, const merlin_capture_files *files, merlin_capture **out)
{
    static const merlin_capture_files usual = {0};
    if (out) *out = NULL;
    status s = api_needs(__func__, folder && out);
    if (!files) files = &usual;
    if (s == OK) s = check_camera(files->field_of_view, files->distance);
    if (s != OK) return s;
    merlin_capture *c = calloc(1, sizeof *c);
    if (!c) return fail(MERLIN_NO_MEMORY, "no memory for a capture");
    const pst_read_options options = {.lights = files->lights,
                                      .mask = files->mask,
                                      .ambient = files->ambient,
                                      .near = files->near_lights != 0,
                                      .unknown_lights = files->unknown_lights != 0,
                                      .linear = files->linear != 0,
                                      .field_of_view = files->field_of_view,
                                      .distance = files->distance};
    s = pst_capture_read(folder, &options, &c->inside);
    if (s == OK && options.near && c->inside.about_object) s = pst_place_lights(&c->inside, NULL);
    if (s != OK)
        merlin_capture_free(c);
    else
        *out = c;
    return s;
}

static status check_params(const merlin_capture_params *p)
{
    if (p->lighting < MERLIN_DISTANT_LIGHTS || p->lighting > MERLIN_UNKNOWN_LIGHTS)
        return fail(MERLIN_WRONG_USE, "no lighting has the number %d", (int)p->lighting);
    return check_camera(p->field_of_view, p->distance);
}

static status take_mask(const merlin_image *mask, pst_capture *c)
{
    if (!mask || !mask->data) return OK;
    if (mask->width < 1 || mask->height < 1) return fail(MERLIN_WRONG_USE, "the mask has no pixels");
    if (mask->channels != 1) return fail(MERLIN_WRONG_USE, "a mask has 1 channel, not %d", mask->channels);
    img from = *mask;
    status s = img_copy(&c->mask, &from);
    for (size_t i = 0; s == OK && i < img_value_count(&c->mask); i++)
        c->mask.data[i] = c->mask.data[i] >= 0.5f;
    c->width = mask->width;
    c->height = mask->height;
    return s;
}

merlin_status merlin_capture_new(const merlin_capture_params *params, const merlin_image *mask, merlin_capture **out)
{
    static const merlin_capture_params usual = {0};
    if (out) *out = NULL;
    status s = api_needs(__func__, out);
    if (!params) params = &usual;
    if (s == OK) s = check_params(params);
    if (s != OK) return s;
    merlin_capture *c = calloc(1, sizeof *c);
    if (!c) return fail(MERLIN_NO_MEMORY, "no memory for a capture");
    c->field_of_view = params->field_of_view;
    c->inside = (pst_capture){.lighting = (pst_lighting)params->lighting,
                              .intensities_known = !params->unknown_intensities,
                              .camera.mean_distance = params->distance};
    s = take_mask(mask, &c->inside);
    if (s != OK) {
        merlin_capture_free(c);
        return s;
    }
    *out = c;
    return MERLIN_OK;
}

static status check_picture(const pst_capture *c, const merlin_image *p)
{
    if (!p->data || p->width < 1 || p->height < 1) return fail(MERLIN_WRONG_USE, "the picture has no pixels");
    if (p->channels != 1 && p->channels != 3)
        return fail(MERLIN_WRONG_USE, "a capture's pictures have 1 or 3 channels, not %d", p->channels);
    if (c->width && (p->width != c->width || p->height != c->height))
        return fail(MERLIN_WRONG_USE, "a picture of %d x %d pixels does not fit a capture of %d x %d", p->width,
                    p->height, c->width, c->height);
    if (c->count && p->channels != c->channels)
        return fail(MERLIN_WRONG_USE, "a picture of %d channels does not fit a capture of %d", p->channels,
                    c->channels);
    img taken = *p;
    for (size_t i = 0; i < img_value_count(&taken); i++)
        if (!isfinite(p->data[i])) return fail(MERLIN_BAD_INPUT, "the picture has values that are not finite");
    return OK;
}

static bool are_finite(const float v[3])
{
    return isfinite(v[0]) && isfinite(v[1]) && isfinite(v[2]);
}

static status take_light(pst_lighting lighting, const merlin_light *from, pst_light *to)
{
    static const merlin_light nothing = {0};
    if (!from && lighting != PST_UNKNOWN_LIGHT)
        return fail(MERLIN_WRONG_USE, "a light is missing: this capture's lights are known");
    if (!from) from = &nothing;
    if (!are_finite(from->direction) || !are_finite(from->position) || !are_finite(from->intensity) ||
        !(from->lobe >= 0 && isfinite(from->lobe)))
        return fail(MERLIN_WRONG_USE, "a light's direction, position, intensity or lobe is not a number");
    vec3 d = vec3_of(from->direction);
    real length = vec3_length(d);
    if (lighting == PST_DISTANT && !(length > 0)) return fail(MERLIN_WRONG_USE, "a distant light has no direction");
    *to = (pst_light){.position = vec3_of(from->position), .lobe = from->lobe};
    if (length > 0) to->direction = vec3_scale(d, 1 / length);
    bool any = from->intensity[0] != 0 || from->intensity[1] != 0 || from->intensity[2] != 0;
    for (int k = 0; k < 3; k++)
        to->intensity[k] = any ? from->intensity[k] : 1;
    return OK;
}

static void take_size(merlin_capture *capture, const merlin_image *picture)
{
    pst_capture *c = &capture->inside;
    c->width = picture->width;
    c->height = picture->height;
    c->channels = picture->channels;
    pst_capture_see(c, capture->field_of_view, c->camera.mean_distance);
}

merlin_status merlin_capture_add(merlin_capture *capture, const merlin_image *picture, const merlin_light *light)
{
    status s = api_needs(__func__, capture && picture);
    if (s != OK) return s;
    pst_light inside;
    s = check_picture(&capture->inside, picture);
    if (s == OK) s = take_light(capture->inside.lighting, light, &inside);
    if (s != OK) return s;
    take_size(capture, picture);
    img taken = *picture;
    return pst_capture_add(&capture->inside, &taken, &inside);
}

void merlin_capture_free(merlin_capture *capture)
{
    if (!capture) return;
    pst_capture_free(&capture->inside);
    free(capture);
}

/* ---- the surface ---- */

static merlin_light light_of(const pst_light *l)
{
    return (merlin_light){{l->direction.x, l->direction.y, l->direction.z},
                          {l->position.x, l->position.y, l->position.z},
                          {l->intensity[0], l->intensity[1], l->intensity[2]},
                          l->lobe};
}

static merlin_image moved(img *from)
{
    merlin_image to = *from;
    *from = (img){0};
    return to;
}

static status take_surface(const pst_capture *c, pst_surface *from, merlin_surface *to)
{
    img mask = {0};
    status s = img_copy(&mask, &c->mask);
    merlin_light *lights = s == OK && from->light ? calloc((size_t)c->count, sizeof *lights) : NULL;
    if (s == OK && from->light && !lights) s = fail(MERLIN_NO_MEMORY, "no memory for %d lights", c->count);
    if (s != OK) {
        img_free(&mask);
        return s;
    }
    for (int i = 0; lights && i < c->count; i++)
        lights[i] = light_of(&from->light[i]);
    *to = (merlin_surface){.normal = moved(&from->normal),
                           .albedo = moved(&from->albedo),
                           .depth = moved(&from->depth),
                           .residual = moved(&from->residual),
                           .mask = moved(&mask),
                           .method = (merlin_stereo_method)from->method,
                           .lights = lights,
                           .light_count = lights ? c->count : 0,
                           .strengths_unsure = from->strengths_unsure,
                           .distance_unsure = from->distance_unsure,
                           .lights_unsure = from->lights_unsure};
    if (!c->camera.perspective) return OK;
    to->camera.focal = c->camera.focal;
    to->camera.x = c->camera.center_x;
    to->camera.y = c->camera.center_y;
    return OK;
}

/* c: with a mask. */
static status solve(const pst_capture *c, const merlin_stereo_params *params, merlin_surface *out)
{
    pst_surface found;
    status s = pst_solve(c, &(pst_options){.method = (pst_method)params->method}, &found);
    if (s != OK) return s;
    s = pst_surface_integrate(c, false, params->keep_edges, NULL, &found);
    if (s == OK) s = take_surface(c, &found, out);
    pst_surface_free(&found);
    return s;
}

merlin_status merlin_stereo(const merlin_capture *capture, const merlin_stereo_params *params, merlin_surface *out)
{
    static const merlin_stereo_params usual = {0};
    if (out) *out = (merlin_surface){0};
    status s = api_needs(__func__, capture && out);
    if (!params) params = &usual;
    if (s == OK && (params->method < MERLIN_STEREO_AUTO || params->method > MERLIN_STEREO_UNCALIBRATED))
        s = fail(MERLIN_WRONG_USE, "no method of photometric stereo has the number %d", (int)params->method);
    if (s == OK && !capture->inside.count) s = fail(MERLIN_WRONG_USE, "the capture has no pictures");
    if (s != OK) return s;
    pst_capture c = capture->inside; /* borrows all but a mask that is found */
    bool search = !c.mask.data;
    if (search) s = pst_capture_find_mask(&c);
    if (s == OK) s = solve(&c, params, out);
    if (search) img_free(&c.mask);
    return s;
}

void merlin_surface_free(merlin_surface *surface)
{
    if (!surface) return;
    merlin_image *images[] = {&surface->normal, &surface->albedo, &surface->depth, &surface->residual, &surface->mask};
    for (size_t i = 0; i < sizeof images / sizeof images[0]; i++) {
        img inside = *images[i];
        img_free(&inside);
    }
    free(surface->lights);
    *surface = (merlin_surface){0};
}

static status check_surface(const merlin_surface *s)
{
    const merlin_image *maps[] = {&s->normal, &s->depth, &s->mask};
    const int channels[] = {3, 1, 1};
    bool sound = s->albedo.data && (s->albedo.channels == 1 || s->albedo.channels == 3);
    for (int i = 0; i < 3; i++)
        sound &= maps[i]->data && maps[i]->channels == channels[i] && maps[i]->width == s->albedo.width &&
                 maps[i]->height == s->albedo.height;
    return sound ? OK : fail(MERLIN_WRONG_USE, "this surface is empty or incomplete");
}

merlin_status merlin_mesh_write(const char *path, const merlin_surface *surface)
{
    status s = api_needs(__func__, path && surface);
    if (s == OK) s = mesh_check_name(path);
    if (s == OK) s = check_surface(surface);
    if (s != OK) return s;
    img normal = surface->normal, depth = surface->depth, mask = surface->mask;
    img relative = surface->albedo, albedo = {0};
    float scale, focal = surface->camera.focal;
    s = img_copy(&albedo, &relative);
    if (s == OK) s = pst_scale_albedo(&albedo, &mask, &scale);
    const mesh_source source = {.depth = &depth,
                                .mask = &mask,
                                .normal = &normal,
                                .albedo = &albedo,
                                .camera = {.perspective = focal > 0, focal, surface->camera.x, surface->camera.y}};
    if (s == OK) s = mesh_write(path, &source);
    img_free(&albedo);
    return s;
}
