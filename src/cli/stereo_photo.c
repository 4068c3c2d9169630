#include "cli/stereo_photo.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/rng.h"
#include "cli/photos.h"
#include "estimate/api.h"
#include "estimate/exposure.h"
#include "optics/light.h"
#include "stereo/integrate.h"

enum { LIGHTS = 50, DRAWS = 5, DRAWN = 32, LARGEST_SIDE = 512, SEED = 1, STREAM_LIGHT = 1, STREAM_DRAW = 2 };
static const float DEGREES = 57.2957795f, SPREAD_WHITE = 20;
/* Radiance that becomes full scale: a white surface facing a light at half the usual distance is not clipped. */
static const float WHITE = 8;

/* Everything relit, and what the draws add up to. */
typedef struct work {
    const stereo_photo *photo;
    merlin_model *model;
    merlin_maps maps;
    stage stage;
    pst_capture all, drawn; /* drawn borrows from all */
    img normals[DRAWS];
    int draws;
} work;

/* ---- the pictures ---- */

static status open_photo(work *w)
{
    const stereo_photo *p = w->photo;
    merlin_image photo = {0}, mask = {0};
    photo_job job = {.photo = (char *)p->photo, .mask = (char *)p->mask};
    status s = photo_read(&job, &photo, &mask);
    if (s == OK) s = (status)merlin_model_open(p->weights, &w->model);
    if (s == OK) {
        s = (status)merlin_estimate(w->model, &photo, &mask, &p->params, &w->maps);
        if (s != OK) s = fail_in(s, "%s", p->photo);
    }
    merlin_image_free(&photo);
    merlin_image_free(&mask);
    if (s != OK) return s;
    int side = w->maps.crop.side < LARGEST_SIDE ? w->maps.crop.side : LARGEST_SIDE;
    s = stage_new(&w->maps, side, MERLIN_BY_BRDF_UNSHADOWED, &w->stage);
    w->stage.white = WHITE;
    return s;
}

static float mean_depth(const surface *s)
{
    double sum = 0, count = 0;
    size_t pixels = (size_t)s->mask.width * (size_t)s->mask.height;
    for (size_t i = 0; i < pixels; i++)
        if (s->mask.data[i] > 0.5f) {
            sum += (double)s->depth.data[i];
            count++;
        }
    return count > 0 ? (float)(sum / count) : 1;
}

static status allocate(work *w)
{
    int side = w->stage.full.mask.width;
    pst_capture *c = &w->all;
    *c = (pst_capture){.width = side, .height = side, .channels = 3, .lighting = PST_NEAR, .intensities_known = true};
    c->camera = (pst_camera){.perspective = true,
                             .focal = (float)side / (2 * tanf(30 / DEGREES)),
                             .center_x = (float)side / 2,
                             .center_y = (float)side / 2,
                             .mean_distance = mean_depth(&w->stage.full)};
    c->picture = calloc(LIGHTS, sizeof *c->picture);
    c->light = calloc(LIGHTS, sizeof *c->light);
    c->name = calloc(LIGHTS, sizeof *c->name);
    if (!c->picture || !c->light || !c->name) return fail(ERROR_MEMORY, "no memory for %d lights", LIGHTS);
    status s = img_copy(&c->mask, &w->stage.full.mask);
    if (s == OK) harden_mask(NULL, &c->mask);
    return s;
}

static status relight_one(work *w, int i)
{
    rng r = rng_at(SEED, (uint64_t)i, STREAM_LIGHT);
    float u1 = rng_uniform(&r), u2 = rng_uniform(&r);
    vec3 at = frontal_light(u1, u2);
    img picture = {0};
    status s = stage_relight(w->model->network, &w->stage, at, &picture);
    if (s != OK) return s;
    size_t values = 3 * (size_t)picture.width * (size_t)picture.height;
    uint16_t *codes = malloc(values * sizeof *codes);
    char *name = NULL;
    if (codes && asprintf(&name, "light %d", i) > 0) {
        for (size_t k = 0; k < values; k++)
            codes[k] = (uint16_t)(picture.data[k] * 65535 + 0.5f);
        float power = (float)LIGHT_POWER / (WHITE * (float)BRDF_PI);
        w->all.picture[i] = codes;
        w->all.name[i] = name;
        w->all.light[i] = (pst_light){.position = at, .intensity = {power, power, power}};
        w->all.count = i + 1;
    } else {
        free(codes);
        s = fail(ERROR_MEMORY, "no memory for %d relit pictures", LIGHTS);
    }
    img_free(&picture);
    return s;
}

static status relight_all(work *w)
{
    status s = allocate(w);
    for (int i = 0; i < LIGHTS && s == OK; i++)
        s = w->photo->params.stop && w->photo->params.stop() ? fail(ERROR_STOPPED, "stopped") : relight_one(w, i);
    return s;
}

/* ---- draws ---- */

/* The first DRAWN of a shuffled order. */
static void choose(int draw, int chosen[DRAWN])
{
    int order[LIGHTS];
    rng r = rng_at(SEED, (uint64_t)draw, STREAM_DRAW);
    for (int i = 0; i < LIGHTS; i++)
        order[i] = i;
    for (int i = 0; i < DRAWN; i++) {
        int other = i + rng_below(&r, LIGHTS - i), keep = order[i];
        chosen[i] = order[other];
        order[other] = keep;
    }
}

static void add_albedo(const pst_surface *s, img *albedo)
{
    size_t values = 3 * (size_t)albedo->width * (size_t)albedo->height, channels = (size_t)s->albedo.channels;
    for (size_t i = 0; i < values; i++)
        albedo->data[i] += s->albedo.data[i / 3 * channels + (channels == 3 ? i % 3 : 0)] / DRAWS;
}

static status solve_draw(work *w, int draw, stereo_result *out)
{
    int chosen[DRAWN];
    choose(draw, chosen);
    for (int i = 0; i < DRAWN; i++) {
        w->drawn.picture[i] = w->all.picture[chosen[i]];
        w->drawn.light[i] = w->all.light[chosen[i]];
        w->drawn.name[i] = w->all.name[chosen[i]];
    }
    pst_method method = w->photo->method == PST_AUTO ? PST_NEAR_LIGHTS : w->photo->method;
    pst_surface found;
    status s = pst_solve(&w->drawn, &(pst_options){.method = method}, &found);
    if (s != OK) return s;
    add_albedo(&found, &out->albedo);
    w->normals[w->draws++] = found.normal;
    found.normal = (img){0};
    pst_surface_free(&found);
    return OK;
}

static status solve_all(work *w, stereo_result *out)
{
    w->drawn = w->all;
    w->drawn.count = DRAWN;
    w->drawn.picture = calloc(DRAWN, sizeof *w->drawn.picture);
    w->drawn.light = calloc(DRAWN, sizeof *w->drawn.light);
    w->drawn.name = calloc(DRAWN, sizeof *w->drawn.name);
    bool complete = w->drawn.picture && w->drawn.light && w->drawn.name;
    status s = complete ? OK : fail(ERROR_MEMORY, "no memory for %d lights", DRAWN);
    for (int d = 0; d < DRAWS && s == OK; d++)
        s = w->photo->params.stop && w->photo->params.stop() ? fail(ERROR_STOPPED, "stopped") : solve_draw(w, d, out);
    free(w->drawn.picture);
    free(w->drawn.light);
    free(w->drawn.name);
    return s;
}

/* ---- mean and spread ---- */

static vec3 normal_at(const img *normal, size_t pixel)
{
    const float *n = normal->data + 3 * pixel;
    return vec3_make(n[0], n[1], n[2]);
}

static float angle(vec3 a, vec3 b)
{
    return DEGREES * atan2f(vec3_length(vec3_cross(a, b)), vec3_dot(a, b));
}

/* Of one pixel; returns the root mean square angle of the draws to their mean, in degrees. */
static float average(const work *w, size_t pixel, float *mean)
{
    vec3 sum = {0, 0, 0};
    for (int d = 0; d < DRAWS; d++)
        sum = vec3_add(sum, normal_at(&w->normals[d], pixel));
    sum = vec3_normalize(sum);
    mean[0] = sum.x;
    mean[1] = sum.y;
    mean[2] = sum.z;
    float square = 0;
    for (int d = 0; d < DRAWS; d++) {
        float a = angle(normal_at(&w->normals[d], pixel), sum);
        square += a * a / DRAWS;
    }
    return sqrtf(square);
}

static void average_all(const work *w, stereo_result *out, cJSON *report)
{
    double spread = 0, off = 0, count = 0;
    size_t pixels = (size_t)out->mask.width * (size_t)out->mask.height;
    for (size_t i = 0; i < pixels; i++) {
        if (out->mask.data[i] <= 0.5f) continue;
        out->error.data[i] = average(w, i, out->normal.data + 3 * i);
        spread += (double)out->error.data[i];
        off += (double)angle(normal_at(&out->normal, i), normal_at(&w->stage.full.normal, i));
        count++;
    }
    cJSON_AddStringToObject(report, "model", merlin_model_name(w->model));
    cJSON_AddNumberToObject(report, "lights", LIGHTS);
    cJSON_AddNumberToObject(report, "draws", DRAWS);
    cJSON_AddNumberToObject(report, "lights_a_draw", DRAWN);
    cJSON_AddNumberToObject(report, "object_pixels", count);
    cJSON_AddNumberToObject(report, "normal_spread_mean_degrees", count > 0 ? spread / count : 0);
    cJSON_AddNumberToObject(report, "angle_to_network_normal_mean_degrees", count > 0 ? off / count : 0);
}

static status result_new(work *w, stereo_result *out)
{
    int side = w->all.width;
    *out = (stereo_result){.error_name = "spread of the normals", .error_white = SPREAD_WHITE, .camera = w->all.camera};
    status s = img_copy(&out->mask, &w->all.mask);
    if (s == OK) s = img_new(&out->normal, side, side, 3);
    if (s == OK) s = img_new(&out->albedo, side, side, 3);
    if (s == OK) s = img_new(&out->error, side, side, 1);
    return s;
}

static void work_free(work *w)
{
    for (int d = 0; d < w->draws; d++)
        img_free(&w->normals[d]);
    pst_capture_free(&w->all);
    stage_free(&w->stage);
    merlin_maps_free(&w->maps);
    merlin_model_close(w->model);
}

status stereo_from_photo(const stereo_photo *p, stereo_result *out, cJSON *report)
{
    work w = {.photo = p};
    *out = (stereo_result){0};
    status s = open_photo(&w);
    if (s == OK) s = relight_all(&w);
    if (s == OK) s = result_new(&w, out);
    if (s == OK) s = solve_all(&w, out);
    if (s == OK) {
        average_all(&w, out, report);
        pst_integration how = {.preserve_edges = p->preserve_edges};
        s = pst_integrate(&out->normal, &out->mask, &out->camera, &how, &out->depth);
    }
    work_free(&w);
    return s;
}
