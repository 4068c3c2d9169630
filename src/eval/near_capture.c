#include "eval/near_capture.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "optics/brdf.h"
#include "optics/light.h"

static float mean_over(const img *values, const img *mask)
{
    double sum = 0, count = 0;
    for (size_t i = 0, n = (size_t)mask->width * (size_t)mask->height; i < n; i++)
        if (mask->data[i] > 0.5f) {
            sum += (double)values->data[i];
            count++;
        }
    return count > 0 ? (float)(sum / count) : 1;
}

status near_capture_new(const img *mask, const img *depth, float field_of_view, int most, pst_capture *out)
{
    int side = mask->width;
    *out = (pst_capture){.width = side,
                         .height = mask->height,
                         .channels = 3,
                         .lighting = PST_NEAR,
                         .intensities_known = true,
                         .camera = pst_camera_of(side, mask->height, field_of_view)};
    out->camera.mean_distance = mean_over(depth, mask);
    out->picture = calloc((size_t)most, sizeof *out->picture);
    out->light = calloc((size_t)most, sizeof *out->light);
    out->name = calloc((size_t)most, sizeof *out->name);
    if (!out->picture || !out->light || !out->name) return fail(ERROR_MEMORY, "no memory for %d lights", most);
    status s = img_copy(&out->mask, mask);
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
