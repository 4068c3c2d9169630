/* SPDX-License-Identifier: MIT */
#include "stereo/methods/solve.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "stereo/fit/pixel_fit.h"
#include "stereo/methods/solve_parts.h"
#include "stereo/methods/unlit.h"

/* Fails for lights listed with z away from the camera, which would give a surface that hardly faces any of them. */
static status check_known_directions(const merlin_light *light, int count)
{
    int behind = 0;
    for (int i = 0; i < count; i++)
        behind += light[i].direction[2] <= 0;
    if (behind == count)
        return fail(MERLIN_BAD_INPUT,
                    "all %d lights stand behind or beside the object (z is nowhere above 0); z of a direction to a "
                    "light points "
                    "toward the camera",
                    count);
    return pst_check_directions(light, count);
}

static merlin_stereo_method choose(const merlin_capture *c)
{
    if (c->lighting == MERLIN_UNKNOWN_LIGHTS) return MERLIN_STEREO_UNCALIBRATED;
    if (c->lighting == MERLIN_NEAR_LIGHTS) return MERLIN_STEREO_NEAR;
    return c->intensities_known ? MERLIN_STEREO_ROBUST : MERLIN_STEREO_SEMI;
}

/* Fails for method near, or one like it, of a capture that it is not for. */
static status check_near(const merlin_capture *c, merlin_stereo_method m)
{
    const char *name = merlin_stereo_method_name(m);
    if (c->lighting != MERLIN_NEAR_LIGHTS)
        return fail(MERLIN_WRONG_USE, "method %s needs light positions, which this capture does not have; use %s", name,
                    c->lighting == MERLIN_DISTANT_LIGHTS
                        ? "robust, or say that its lights are near if its list holds positions"
                        : "--method uncalibrated");
    if (!(c->camera.focal > 0)) return fail(MERLIN_WRONG_USE, "method %s needs the camera's focal length", name);
    return pst_check_positions(c->light, c->count);
}

/* fewest: least number of pictures. */
static status check_method(const merlin_capture *c, merlin_stereo_method m, int fewest)
{
    bool distant = m == MERLIN_STEREO_LS || m == MERLIN_STEREO_ROBUST || m == MERLIN_STEREO_SEMI;
    if (distant && c->lighting != MERLIN_DISTANT_LIGHTS)
        return fail(MERLIN_WRONG_USE, "method %s needs light directions, which this capture does not have; use %s",
                    merlin_stereo_method_name(m), c->lighting == MERLIN_NEAR_LIGHTS ? "near" : "--method uncalibrated");
    if (c->count < fewest)
        return fail(MERLIN_BAD_INPUT, "photometric stereo needs pictures under %d or more lights, not %d", fewest,
                    c->count);
    if (c->count > PST_MAX_LIGHTS && m != MERLIN_STEREO_LS)
        return fail(MERLIN_BAD_INPUT, "%d pictures are more than the %d that method %s solves%s", c->count,
                    PST_MAX_LIGHTS, merlin_stereo_method_name(m),
                    c->lighting == MERLIN_DISTANT_LIGHTS ? "; use ls" : "");
    if (m == MERLIN_STEREO_NEAR || m == MERLIN_STEREO_NFPS) return check_near(c, m);
    return distant ? check_known_directions(c->light, c->count) : OK;
}

static status check_mask(const merlin_capture *c)
{
    if (c->mask.width != c->width || c->mask.height != c->height)
        return fail(MERLIN_BAD_INPUT, "the mask is %d x %d pixels, the pictures are %d x %d", c->mask.width,
                    c->mask.height, c->width, c->height);
    size_t size = (size_t)c->width * (size_t)c->height;
    for (size_t i = 0; i < size; i++)
        if (c->mask.data[i] > 0.5f) return OK;
    return fail(MERLIN_BAD_INPUT, "the mask is empty: no pixel of the object is left to solve");
}

/* Number of the object's pixels that are examined, evenly spread, so that large pictures are not read twice. */
enum { ENOUGH = 1 << 18 };
static size_t some_pixels(const merlin_capture *c, uint32_t some[ENOUGH])
{
    size_t pixels = (size_t)c->width * (size_t)c->height, inside = 0, count = 0;
    for (size_t i = 0; i < pixels; i++)
        inside += c->mask.data[i] > 0.5f;
    for (size_t i = 0, met = 0, step = inside / ENOUGH + 1; i < pixels; i++)
        if (c->mask.data[i] > 0.5f && met++ % step == 0) some[count++] = (uint32_t)i;
    return count;
}

/* Returns the mean over these pixels, as if the light had intensity 1. */
static double mean_seen(const pst_problem *p, int k, const uint32_t *some, size_t count)
{
    size_t channels = (size_t)p->capture->channels;
    double sum = 0;
    for (size_t i = 0; i < count; i++)
        for (size_t ch = 0; ch < channels; ch++)
            sum +=
                (double)pst_code(&p->capture->picture[k], some[i] * channels + ch) / (double)p->light[k].intensity[ch];
    return sum / (double)count;
}

/* Checks that few pictures include no black one: a flash that failed would count as shadow everywhere, and turn normals
 * away from its light. */
static status check_lit(const pst_problem *p)
{
    enum { FEW = 8 };
    static const double BLACK =
        0.02; /* share of the brightest picture; noise alone is below it, the weakest light above */
    const merlin_capture *c = p->capture;
    if (c->count >= FEW) return OK;
    uint32_t *some = malloc(ENOUGH * sizeof *some);
    if (!some) return fail(MERLIN_NO_MEMORY, "no memory for a list of pixels");
    size_t count = some_pixels(c, some);
    double mean[FEW], most = 0;
    for (int k = 0; k < c->count; k++)
        most = fmax(most, mean[k] = mean_seen(p, k, some, count));
    free(some);
    for (int k = 0; k < c->count; k++)
        if (mean[k] < BLACK * most)
            return fail(MERLIN_BAD_INPUT, "picture %d%s%s is black: did its light fail? leave it and its light out",
                        k + 1, c->name ? ", " : "", c->name ? c->name[k] : "");
    return OK;
}

/* Range of intensities: beyond it squares of albedos would exceed the range of floats, or be lost next to the damping
 * of divisions. */
static const float least_intensity = 1e-15f, largest_intensity = 1e15f;

/* Intensities that are unknown or to be found count as 1; a light of intensity 0 would cause a division by zero. */
status pst_list_lights(const merlin_capture *c, merlin_stereo_method method, merlin_light *light)
{
    for (int i = 0; i < c->count; i++) {
        light[i] = c->light ? c->light[i] : (merlin_light){0};
        float *e = light[i].intensity;
        bool unknown =
            method == MERLIN_STEREO_SEMI || !c->intensities_known || !c->light || (e[0] == 0 && e[1] == 0 && e[2] == 0);
        for (int k = 0; k < 3; k++) {
            if (unknown || (k >= c->channels && !(e[k] > 0))) e[k] = 1;
            if (!(e[k] > 0))
                return fail(MERLIN_BAD_INPUT, "light %d has the intensity %g; it must be above 0", i + 1, (double)e[k]);
            if (!(e[k] >= least_intensity && e[k] <= largest_intensity))
                return fail(MERLIN_BAD_INPUT,
                            "light %d has the intensity %g; give all lights' in another unit, %g to %g", i + 1,
                            (double)e[k], (double)least_intensity, (double)largest_intensity);
        }
    }
    return OK;
}

static status allocate_map(const merlin_capture *c, int channels, img *out)
{
    status s = img_new(out, c->width, c->height, channels);
    size_t count = (size_t)c->width * (size_t)c->height * (size_t)channels;
    if (s == OK) memory_prefer_large_pages(out->data, count * sizeof(float));
    return s;
}

static status allocate(const merlin_capture *c, merlin_surface *out)
{
    status s = allocate_map(c, 3, &out->normal);
    if (s == OK) s = allocate_map(c, c->channels, &out->albedo);
    if (s == OK) s = allocate_map(c, 1, &out->residual);
    if (s == OK && out->method != MERLIN_STEREO_LS) s = allocate_map(c, 1, &out->spread);
    if (s == OK) s = img_copy(&out->mask, &c->mask);
    return s;
}

static status run(const pst_problem *p, merlin_surface *out)
{
    switch (out->method) {
    case MERLIN_STEREO_LS:
        return pst_solve_ls(p, out);
    case MERLIN_STEREO_ROBUST:
        return pst_solve_robust(p, out);
    case MERLIN_STEREO_NEAR:
        return pst_solve_near(p, out);
    case MERLIN_STEREO_SEMI:
        return pst_solve_semi(p, out);
    case MERLIN_STEREO_UNCALIBRATED:
        return pst_solve_uncalibrated(p, out);
    case MERLIN_STEREO_NFPS:
        return pst_solve_given(p, out);
    default:
        return fail(MERLIN_WRONG_USE, "there is no such method of photometric stereo");
    }
}

/* Estimates the effort. A fit without a start counts as four; each method makes a multiple of the pixels, the first
 * rounds of near on small pictures. */
static size_t expected_effort(const pst_problem *p, merlin_stereo_method method)
{
    static const size_t passes[] = {[MERLIN_STEREO_ROBUST] = 9,
                                    [MERLIN_STEREO_NEAR] = 11,
                                    [MERLIN_STEREO_SEMI] = 9,
                                    [MERLIN_STEREO_UNCALIBRATED] = 13,
                                    [MERLIN_STEREO_NFPS] = 2};
    enum { SMALL_ONES = 300000 };
    bool known = (size_t)method < sizeof passes / sizeof *passes;
    return (known ? passes[method] : 1) * p->pixel_count + (method == MERLIN_STEREO_NEAR ? SMALL_ONES : 0) + 1;
}

/* Expectations from elsewhere: a surface and lights, or a guide who is asked for the surface. */
typedef struct expecting {
    const pst_expected *expected;
    const pst_guide *guide;
} expecting;

/* Asks at the distance that is known, or that of the best plane, and then of what was found at that one. */
static status ask(pst_problem *p, const pst_guide *guide, const watch *w, img *normal, img *depth)
{
    static const float near_enough = 0.03f;
    merlin_capture told = *p->capture; /* borrows everything */
    const bool known = told.camera.distance > 0;
    const pst_expected found = {.normal = normal, .depth = depth};
    float distance = told.camera.distance;
    status s = known ? OK : pst_near_distance(p, 0, &told.camera.distance);
    if (s == OK) s = guide->find(guide->context, &told, w, normal, depth);
    if (s != OK || known) return s;
    p->expected = &found;
    s = pst_near_distance(p, told.camera.distance, &distance);
    p->expected = NULL;
    if (s != OK || fabsf(distance / told.camera.distance - 1) < near_enough) return s;
    img_free(normal);
    img_free(depth);
    told.camera.distance = distance;
    return guide->find(guide->context, &told, w, normal, depth);
}

/* Runs the method with what the guide finds, if there is one and the method is for near lights. */
static status run_guided(pst_problem *p, const pst_guide *guide, const watch *w, merlin_surface *out)
{
    const bool near = out->method == MERLIN_STEREO_NEAR || out->method == MERLIN_STEREO_NFPS;
    img normal = {0}, depth = {0};
    if (!guide || !near) return run(p, out);
    const pst_expected found = {.normal = &normal, .depth = &depth, .normals_alone = guide->normals_alone};
    status s = ask(p, guide, w, &normal, &depth);
    p->expected = &found;
    if (s == OK) s = run(p, out);
    p->expected = NULL;
    img_free(&normal);
    img_free(&depth);
    return s;
}

static status check_expecting(const merlin_capture *c, merlin_stereo_method m, expecting e)
{
    if (m == MERLIN_STEREO_NFPS && !e.guide)
        return fail(MERLIN_WRONG_USE, "method nfps needs a network, which merlin_stereo_by_network takes");
    return check_method(c, m, e.expected ? 2 : 3);
}

static status solve(const merlin_capture *c, const merlin_stereo_params *params, expecting e, merlin_surface *out)
{
    const watch shown = {params->progress, params->progress_context, params->stop};
    *out = (merlin_surface){.method = params->method == MERLIN_STEREO_AUTO ? choose(c) : params->method,
                            .camera = c->camera};
    status s = check_expecting(c, out->method, e);
    if (s != OK) return s;
    merlin_light *light = calloc((size_t)c->count, sizeof *light);
    if (!light) return fail(MERLIN_NO_MEMORY, "no memory for %d lights", c->count);
    pst_problem p = {.capture = c,
                     .light = light,
                     .saturation = PST_SATURATED,
                     .iterations = params->iterations,
                     .expected = e.expected};
    pst_effort effort = {.watch = &shown, .owner = pthread_self()};
    if (shown.tell || shown.stop) p.effort = &effort;
    watch_tell(&shown, "solving", 0);
    s = pst_list_lights(c, out->method, light);
    if (s == OK) s = check_mask(c);
    if (s == OK && out->method != MERLIN_STEREO_SEMI && out->method != MERLIN_STEREO_UNCALIBRATED) s = check_lit(&p);
    if (s == OK && out->method != MERLIN_STEREO_LS) s = pst_list_pixels(c, &p);
    effort.expected = expected_effort(&p, out->method);
    if (s == OK) s = allocate(c, out);
    if (s == OK) s = run_guided(&p, e.guide, &shown, out);
    if (s == OK && p.effort)
        pst_effort_add(&effort, 0); /* reports the end, as other threads may have fitted the last pixels */
    if (s == OK && p.pixel && !out->depth.data) s = pst_unlit_fill(&p, out);
    if (s == OK && out->lights) out->light_count = c->count;
    free(p.pixel);
    free(light);
    if (s != OK) merlin_surface_free(out);
    return s;
}

status pst_solve(const merlin_capture *c, const merlin_stereo_params *params, merlin_surface *out)
{
    return solve(c, params, (expecting){0}, out);
}

status pst_solve_expecting(const merlin_capture *c, const merlin_stereo_params *params, const pst_expected *expected,
                           merlin_surface *out)
{
    return solve(c, params, (expecting){.expected = expected}, out);
}

status pst_solve_guided(const merlin_capture *c, const merlin_stereo_params *params, const pst_guide *guide,
                        merlin_surface *out)
{
    return solve(c, params, (expecting){.guide = guide && guide->find ? guide : NULL}, out);
}
