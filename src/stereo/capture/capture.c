/* SPDX-License-Identifier: MIT */
#include "stereo/capture/capture.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/number.h"
#include "optics/camera.h"

status pst_capture_reserve(merlin_capture *c, size_t count)
{
    if (count < 1 || count > PST_MOST_PICTURES)
        return fail(MERLIN_BAD_INPUT, "a capture has 1 to %d pictures, not %zu", PST_MOST_PICTURES, count);
    c->light = calloc(count, sizeof *c->light);
    c->name = calloc(count, sizeof *c->name);
    c->picture = calloc(count, sizeof *c->picture);
    if (!c->light || !c->name || !c->picture) return fail(MERLIN_NO_MEMORY, "no memory for %zu lights", count);
    c->count = (int)count;
    for (size_t i = 0; i < count; i++)
        for (int k = 0; k < 3; k++)
            c->light[i].intensity[k] = 1;
    return OK;
}

status pst_capture_set_name(merlin_capture *c, size_t i, const char *name)
{
    c->name[i] = strdup(name);
    return c->name[i] ? OK : fail(MERLIN_NO_MEMORY, "no memory for a file name");
}

static status make_room(merlin_capture *c)
{
    size_t count = (size_t)c->count + 1;
    if (count > PST_MOST_PICTURES)
        return fail(MERLIN_WRONG_USE, "a capture has %d pictures at most", PST_MOST_PICTURES);
    merlin_light *light = realloc(c->light, count * sizeof *light);
    if (light) c->light = light;
    char **name = realloc(c->name, count * sizeof *name);
    if (name) c->name = name;
    pst_plane *picture = realloc(c->picture, count * sizeof *picture);
    if (picture) c->picture = picture;
    return light && name && picture ? OK : fail(MERLIN_NO_MEMORY, "no memory for %zu lights", count);
}

static uint16_t code_of(float value)
{
    return (uint16_t)(clamp(value, 0, 1) * 65535 + 0.5f);
}

status pst_capture_add(merlin_capture *c, const img *picture, const merlin_light *light)
{
    status s = make_room(c);
    if (s != OK) return s;
    size_t values = img_value_count(picture);
    uint16_t *codes = malloc(values * sizeof *codes);
    char *name = NULL;
    if (!codes || asprintf(&name, "light %d", c->count) < 0) {
        free(codes);
        return fail(MERLIN_NO_MEMORY, "no memory for one more picture");
    }
    for (size_t i = 0; i < values; i++)
        codes[i] = code_of(picture->data[i]);
    pst_plane_take(codes, values, &c->picture[c->count]);
    c->name[c->count] = name;
    c->light[c->count++] = *light;
    return OK;
}

void pst_capture_free(merlin_capture *c)
{
    for (int i = 0; i < c->count; i++) {
        if (c->picture) pst_plane_free(&c->picture[i]);
        if (c->name) free(c->name[i]);
    }
    free(c->picture);
    free(c->name);
    free(c->light);
    skipped_free(&c->skipped);
    img_free(&c->mask);
    img_free(&c->normal_true);
    img_free(&c->depth_true);
    *c = (merlin_capture){0};
}

void pst_capture_forget_lights(merlin_capture *c)
{
    for (int i = 0; i < c->count; i++) {
        const float *e = c->light[i].intensity;
        c->light[i] = (merlin_light){.intensity = {e[0], e[1], e[2]}};
    }
    c->lighting = MERLIN_UNKNOWN_LIGHTS;
}

float pst_lights_reach(const merlin_capture *c)
{
    double sum = 0;
    for (int k = 0; k < c->count; k++)
        sum += (double)vec3_length(vec3_of(c->light[k].position));
    return fmaxf((float)(sum / c->count), 1e-6f);
}

void pst_capture_see(merlin_capture *c, float field_of_view, float distance)
{
    const bool wanted = c->lighting == MERLIN_NEAR_LIGHTS && !pinhole_is_near(&c->camera);
    if (!(distance > 0)) distance = c->camera.distance;
    const bool usual = wanted && !(field_of_view > 0) && !(c->focal_35mm > 0);
    c->lens_assumed = usual || (c->lens_assumed && !(field_of_view > 0));
    if (field_of_view > 0 || wanted)
        c->camera = pinhole_known(c->width, c->height, usual ? CAMERA_FOV : field_of_view, c->focal_35mm);
    c->camera.distance = distance;
}
