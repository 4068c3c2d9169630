#include "eval/near_capture.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "eval/metrics.h"
#include "optics/brdf.h"
#include "optics/light.h"

status near_capture_new(const img *mask, const img *depth, float field_of_view, int most, pst_capture *out)
{
    int side = mask->width;
    *out = (pst_capture){.width = side,
                         .height = mask->height,
                         .channels = 3,
                         .lighting = PST_NEAR,
                         .intensities_known = true,
                         .camera = pst_camera_of(side, mask->height, field_of_view)};
    out->camera.mean_distance = (float)eval_mean(depth, mask);
    status s = pst_capture_reserve(out, (size_t)most);
    out->count = 0; /* until they are added */
    if (s == OK) s = img_copy(&out->mask, mask);
    for (size_t i = 0, n = (size_t)side * (size_t)mask->height; s == OK && i < n; i++)
        out->mask.data[i] = mask->data[i] > 0.5f;
    return s;
}

status near_capture_add(pst_capture *c, const img *picture, vec3 light)
{
    size_t values = 3 * (size_t)c->width * (size_t)c->height;
    uint16_t *codes = malloc(values * sizeof *codes);
    char *name = NULL;
    if (!codes || asprintf(&name, "light %d", c->count) < 0) {
        free(codes);
        return fail(ERROR_MEMORY, "no memory for one more picture");
    }
    for (size_t i = 0; i < values; i++)
        codes[i] = (uint16_t)(fminf(fmaxf(picture->data[i], 0), 1) * 65535 + 0.5f);
    float power = (float)LIGHT_POWER / (NEAR_CAPTURE_WHITE * (float)BRDF_PI);
    c->picture[c->count] = codes;
    c->name[c->count] = name;
    c->light[c->count++] = (pst_light){.position = light, .intensity = {power, power, power}};
    return OK;
}
