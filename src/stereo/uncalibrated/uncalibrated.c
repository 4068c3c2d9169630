/* SPDX-License-Identifier: MIT */
/* Photometric stereo with lights of unknown position or direction. They are estimated twice, as near
 * (uncalibrated_near.c) and as distant ones (uncalibrated_distant.c); those that explain a sample of pixels better are
 * used, and the robust fit does the rest. The further near lights are, the less they fall off, and the less a bowl
 * under them differs from a ball photographed with low contrast: then the surface more similar to the inflated outline
 * is used. Where a surface and lights are expected from elsewhere (pst_expected), those that agree plainly better with
 * both are used.
 *
 * Without a camera the pictures are taken to be orthographic, which is a perspective from far away. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "stereo/capture/shrink.h"
#include "stereo/fit/field_fit.h"
#include "stereo/fit/lobe_choice.h"
#include "stereo/fit/samples.h"
#include "stereo/fit/smaller_problem.h"
#include "stereo/integrate/integrate.h"
#include "stereo/methods/solve_parts.h"
#include "stereo/uncalibrated/inflate.h"
#include "stereo/uncalibrated/uncalibrated_parts.h"

/* ENOUGH: number of pixels by which lights are found, up to four times as many. */
enum { SAMPLE = 400, ADMITTING = 192, DIFFERING = 1500, ENOUGH = 200000 };
/* Ratio of near to distant lights' costs below which near ones are used, as they have one more unknown per picture and
 * a free distance. Measured on rendered objects: 0.1 to 0.7 if lights were an object's size or two away, 0.84 to 1.2 if
 * they were distant. */
static const double clearly = 0.8;
/* Factor of the cost of a solution of which more than PST_MOST_AWAY faces away. */
static const double absurd = 1e3;
/* Focal length of the camera that stands for none, in widths of the picture. */
static const float far_away = 30;
/* Distances of near lights in the object's radii: from the second on they are distant ones, whose distances stand for
 * their strengths; from the first on they are not preferred against the outline. Measured: 2.2 to 4.1 if they were
 * truly near (also with bowls), 8 and more if they were distant. The effect is stated in docs/notes/unknown_lights.md.
 */
static const double doubtful = 5, farthest = 10;
/* Largest loss of similarity to the inflated outline compared with distant lights, as a mean cosine. */
static const double less_like = 0.3;

/* Difference of agreement with an expected surface and lights from which on that decides, not the costs: a mean cosine,
 * less the lights' mean angle over `full_aside` degrees. Measured with near lights about 14 rendered objects, 8 to 52
 * of them: where distant ones agreed better, by at most 0.15, they were doubtful themselves; of an owl whose tone curve
 * makes a bowl of it they agree better by 0.27 to 0.36. */
static const double plainly = 0.05, full_aside = 60;
/* Difference from which on lights found without what is expected take the place of those found with it: of a relief in
 * eight pictures, of which the latter go astray, it is above 0.4; of plain balls, of which they are better, up to 0.07.
 */
static const double far_ahead = 0.15;

/* Cost per value from which on, and similarity to the inflated outline below which, there is a warning about near
 * lights. Measured: of 15 captures with errors below 10 degrees none had more than 0.19 or less than 0.6; a cat and a
 * plane under distant lights that were taken for near ones, with errors of 31 and 34 degrees, had 0.26 and 0.48. */
static const double costly = 0.2, unlike = 0.55;
/* Similarity to the expected surface below which there is one about near lights of different strengths, which explain
 * much. Measured: 0.90 to 0.99 of rendered objects whose exposures differed; 0.57 to 0.75 of an owl whose tone curve
 * was not undone, with an error of 35 degrees. */
static const double unlike_uneven = 0.85;

/* Cost per value, and mean angle in degrees between the lights and the expected ones, from which on there is one about
 * distant lights. Measured: of distant ones with errors below 10 degrees none had more than 0.23 and 20; where the
 * lights were near, or the error was above 20, most had more. */
static const double unexplained = 0.25, astray = 35;

/* Lights of one kind, and how well they explain the pictures. */
typedef struct hypothesis {
    merlin_light *light; /* count lights */
    img depth;           /* depth found with near lights; else empty */
    double cost;
    double cost_of_value;  /* the same per value of the sample, in [0, 1] */
    bool faces_away;       /* whether more than PST_MOST_AWAY of it does */
    double likeness;       /* mean cosine between the sample's normals and the expected ones */
    double aside;          /* mean angle between its lights and the expected ones, degrees; 0: none are expected */
    pst_rotation rotation; /* rotation found with distant lights */
    bool uneven;           /* whether the lights are not equally strong */
} hypothesis;

static pinhole perspective_of(const merlin_capture *c)
{
    pinhole camera = c->camera;
    if (!pinhole_is_near(&camera))
        camera = (pinhole){.focal = far_away * (float)(c->width > c->height ? c->width : c->height),
                           .x = 0.5f * (float)c->width,
                           .y = 0.5f * (float)c->height};
    if (!(camera.distance > 0)) camera.distance = 1;
    return camera;
}

static double share_away(const pst_field *f)
{
    size_t away = 0, width = (size_t)f->problem->capture->width;
    for (size_t i = 0; i < f->count; i++) {
        int x = (int)(f->pixel[i] % width), y = (int)(f->pixel[i] / width);
        away += vec3_dot(f->b[i], pst_ray(&f->problem->capture->camera, x, y)) > 0;
    }
    return (double)away / (double)f->count;
}

static double likeness(const pst_field *f, const img *expected)
{
    double sum = 0;
    for (size_t i = 0; i < f->count; i++)
        sum += (double)vec3_dot(vec3_normalize(f->b[i]), vec3_of(expected->data + 3 * (size_t)f->pixel[i]));
    return sum / (double)f->count;
}

/* Returns the mean angle between lights and those that are expected, weighted by how probable these are. */
static double aside(const pst_problem *p, const hypothesis *h)
{
    double sum = 0, weights = 0;
    for (int k = 0; p->expected && k < p->capture->count; k++) {
        const vec3 to = p->expected->light[k], position = vec3_of(h->light[k].position);
        const double sure = (double)vec3_length(to);
        if (!(sure > 0)) continue;
        const vec3 middle = {0, 0, -p->capture->camera.distance};
        const vec3 found = h->depth.data ? vec3_sub(position, middle) : vec3_of(h->light[k].direction);
        sum += sure * vec3_angle(to, found);
        weights += sure;
    }
    return weights > 0 ? sum / weights : 0;
}

/* Computes the cost by the robust fit of a sample. */
static status evaluate(const pst_problem *p, const img *expected, hypothesis *h)
{
    uint32_t *pixel;
    pst_problem under = *p;
    under.light = h->light;
    pst_field f = {.problem = &under, .scale = 1, .depth = h->depth.data ? &h->depth : NULL};
    status s = pst_field_sample(p, SAMPLE, &pixel, &f.count);
    if (s != OK) return s;
    f.pixel = pixel;
    f.b = calloc(f.count, sizeof *f.b);
    size_t values = f.count * (size_t)p->capture->count;
    s = f.b ? pst_field_fit(&f, &h->cost) : fail(MERLIN_NO_MEMORY, "no memory for a sample of %zu pixels", f.count);
    h->cost_of_value = h->cost / fmax((double)values, 1);
    if (s == OK) h->faces_away = share_away(&f) > PST_MOST_AWAY;
    if (h->faces_away) h->cost *= absurd;
    if (s == OK) h->likeness = likeness(&f, expected);
    if (s == OK) h->aside = aside(p, h);
    free(f.b);
    free(pixel);
    return s;
}

/* Decides whether to fit a highlight's lobe; f's pixels become all of the problem's. */
static status admit_lobe(pst_field *f, pst_lobe *lobe)
{
    uint32_t *sample;
    status s = pst_field_sample(f->problem, ADMITTING, &sample, &f->count);
    if (s != OK) return s;
    f->pixel = sample;
    s = pst_lobe_admit(f, lobe);
    free(sample);
    f->pixel = f->problem->pixel;
    f->count = f->problem->pixel_count;
    return s;
}

/* Fits normals with the depth found with the lights, then integrates a finer depth. Further rounds gain nothing, as
 * that depth fits the lights that were found with it, including their errors. */
static status solve_near(const pst_problem *p, const img *depth, merlin_surface *out)
{
    const pst_integration how = {.prior = depth, .prior_weight = PST_KEEP_DEPTH};
    pst_lobe lobe = {.masking = 0.28f, .tail = 2, .width = 0.04f, .shadow = PST_SHADOW_COST};
    pst_field f = {.problem = p, .depth = depth, .scale = 1, .lobe = &lobe};
    double cost;
    f.shading = calloc(p->pixel_count, sizeof *f.shading);
    if (!f.shading) return fail(MERLIN_NO_MEMORY, "no memory to fit %zu pixels", p->pixel_count);
    status s = admit_lobe(&f, &lobe);
    if (s == OK) s = pst_field_fit(&f, &cost);
    if (s == OK) s = pst_field_store(&f, out);
    if (s == OK) s = pst_integrate(&out->normal, &p->capture->mask, &p->capture->camera, &how, &out->depth);
    free(f.shading);
    return s;
}

/* Returns the mean distance of near lights in the object's radii. */
static double mean_distance(const pst_problem *p, const hypothesis *h)
{
    const pinhole *camera = &p->capture->camera;
    float radius = sqrtf((float)p->pixel_count / 3.1415927f) / camera->focal * camera->distance;
    double sum = 0;
    for (int k = 0; k < p->capture->count; k++)
        sum += (double)vec3_length(vec3_sub(vec3_of(h->light[k].position), vec3_make(0, 0, -camera->distance)));
    return sum / (double)radius / p->capture->count;
}

static status find_near(const pst_problem *p, const img *expected, hypothesis *h, double *distance)
{
    pst_near_found found;
    status s = pst_find_near_lights(p, &p->capture->camera, &found);
    if (s == OK) {
        memcpy(h->light, found.light, (size_t)p->capture->count * sizeof *h->light);
        h->depth = found.depth;
        h->uneven = found.uneven;
        found.depth = (img){0};
    }
    pst_near_found_free(&found);
    if (s != OK) return s;
    *distance = mean_distance(p, h);
    if (*distance >= farthest) return fail(MERLIN_BAD_INPUT, "the lights are not near");
    return evaluate(p, expected, h);
}

/* Measures how well lights and surface agree with what is expected. */
static double agreement(const hypothesis *h)
{
    return h->likeness - h->aside / full_aside;
}

/* Finds distant lights, and evaluates them; under: the problem with or without what is expected. */
static status try_distant(const pst_problem *p, const pst_problem *under, const img *inflated, const img *expected,
                          hypothesis *h)
{
    status s = pst_find_distant_lights(under, inflated, h->light, &h->rotation);
    h->uneven = h->rotation.uneven;
    return s == OK ? evaluate(p, expected, h) : s;
}

/* Finds distant lights without what is expected, and uses them if they agree far better with it: that happens where
 * few pictures leave more open than the lights' strengths. */
static status find_plain(const pst_problem *p, const img *inflated, const img *expected, hypothesis *h)
{
    pst_problem plain = *p;
    plain.expected = NULL;
    hypothesis other = {.light = calloc((size_t)p->capture->count, sizeof *other.light)};
    if (!other.light) return fail(MERLIN_NO_MEMORY, "no memory for %d lights", p->capture->count);
    status s = try_distant(p, &plain, inflated, expected, &other);
    if (s == OK && agreement(&other) > agreement(h) + far_ahead) {
        merlin_light *unused = h->light;
        *h = other;
        other.light = unused;
    }
    free(other.light);
    return s == MERLIN_BAD_INPUT ? OK : s;
}

static status find_distant(const pst_problem *p, const img *inflated, const img *expected, hypothesis *h)
{
    status s = try_distant(p, p, inflated, expected, h);
    return s == OK && p->expected ? find_plain(p, inflated, expected, h) : s;
}

/* Tells whether lights of one kind are doubtful. */
static bool is_unsure(const pst_problem *p, const hypothesis *h, bool near)
{
    if (p->expected && h->faces_away) return true;
    if (near && p->expected && h->uneven && h->likeness < unlike_uneven) return true;
    if (near) return h->cost_of_value > costly || h->likeness < unlike;
    return p->expected ? h->cost_of_value > unexplained || h->aside > astray : h->rotation.unsure;
}

/* Discards lights that agree plainly worse with what is expected than others that are not doubtful themselves. */
static void decide_as_expected(const pst_problem *p, hypothesis *near, hypothesis *distant)
{
    const double ahead = agreement(near) - agreement(distant);
    if (ahead > plainly && !is_unsure(p, near, true)) distant->cost = HUGE_VAL;
    if (ahead < -plainly && !is_unsure(p, distant, false)) near->cost = HUGE_VAL;
}

/* Finds near lights where they are known to be of that kind. */
static status find_near_alone(const pst_problem *p, hypothesis *near, hypothesis *distant)
{
    double distance;
    distant->cost = HUGE_VAL;
    return find_near(p, p->expected->normal, near, &distance);
}

/* Finds both kinds of lights; impossible ones have an infinite cost. */
static status find_both(const pst_problem *p, hypothesis *near, hypothesis *distant)
{
    img inflated = {0}, height = {0};
    double distance = 0;
    if (p->expected && p->expected->near_alone) return find_near_alone(p, near, distant);
    status s = pst_inflate(&p->capture->mask, &inflated, &height);
    if (s != OK) return s;
    img_free(&height);
    const img *expected = p->expected ? p->expected->normal : &inflated;
    status found = find_near(p, expected, near, &distance);
    if (found == OK || found == MERLIN_BAD_INPUT) s = find_distant(p, &inflated, expected, distant);
    img_free(&inflated);
    if (found != OK && found != MERLIN_BAD_INPUT) return found;
    if (s != OK && (s != MERLIN_BAD_INPUT || found != OK)) return s;
    if (s != OK) distant->cost = HUGE_VAL;
    bool is_astray = s == OK && distance > doubtful && near->likeness < distant->likeness - less_like;
    if (found == OK && s == OK && p->expected) decide_as_expected(p, near, distant);
    if (found != OK || is_astray) near->cost = HUGE_VAL;
    return OK;
}

/* Finds both kinds of lights by fewer pixels where there are many. The depth is for all. */
static status find_by_fewer(const pst_problem *p, hypothesis *near, hypothesis *distant)
{
    smaller_problem small;
    status s = smaller_problem_new(p, ENOUGH, &small);
    if (s == OK) s = find_both(&small.problem, near, distant);
    if (s == OK && small.factor > 1 && near->depth.data) {
        img depth = {0};
        s = img_new(&depth, p->capture->width, p->capture->height, 1);
        if (s == OK) pst_enlarge(&near->depth, &small.capture.mask, &p->capture->mask, small.factor, &depth);
        img_free(&near->depth);
        near->depth = depth;
    }
    smaller_problem_free(&small);
    return s;
}

/* Says that the surface's lights have positions, or removes these and the depth, which are in the space of an unknown
 * camera. */
static void name_places(const pst_problem *p, bool camera_known, merlin_surface *out)
{
    out->lights_near = camera_known;
    if (camera_known) return;
    img_free(&out->depth);
    for (int k = 0; k < p->capture->count && out->lights; k++)
        vec3_put((vec3){0}, out->lights[k].position);
}

/* Solves with these lights and stores them in the surface. */
static status solve_as(const pst_problem *p, hypothesis *h, bool camera_known, merlin_surface *out)
{
    out->lights = h->light;
    h->light = NULL;
    pst_problem found = *p;
    found.light = out->lights;
    if (!h->depth.data) return pst_solve_robust(&found, out);
    status s = solve_near(&found, &h->depth, out);
    name_places(p, camera_known, out);
    return s;
}

/* Stores near lights and the depth that was found with them. */
static status take_lights(hypothesis *h, merlin_surface *out)
{
    out->lights = h->light;
    out->depth = h->depth;
    out->lights_near = true;
    h->light = NULL;
    h->depth = (img){0};
    return OK;
}

static status solve_few(const pst_problem *p, bool camera_known, merlin_surface *out)
{
    status s = pst_solve_few(p, camera_known, out);
    name_places(p, camera_known, out);
    return s;
}

/* Fails for a plane under distant lights, whose pictures differ only in brightness, so that any lights explain them
 * equally well. */
static status check_not_flat(const pst_problem *p)
{
    pst_samples m;
    bool differ = true;
    status s = pst_samples_new(p, DIFFERING, &m);
    if (s != OK) return s;
    s = pst_samples_differ(&m, &differ);
    pst_samples_free(&m);
    if (s == OK && !differ)
        s = fail(MERLIN_BAD_INPUT,
                 "the pictures differ in nothing but their brightness, as those of a plane do: they do not "
                 "tell where the lights are");
    return s;
}

status pst_solve_uncalibrated(const pst_problem *p, merlin_surface *out)
{
    const merlin_capture *c = p->capture;
    size_t count = (size_t)c->count;
    const bool few = count < PST_FEWEST_UNKNOWN, helped = p->expected && p->expected->depth && p->expected->compared;
    if (few && !helped)
        return fail(MERLIN_BAD_INPUT, "unknown lights need %d or more pictures, not %d", PST_FEWEST_UNKNOWN, c->count);
    merlin_capture seen = *c;
    pst_problem q = *p;
    seen.camera = perspective_of(c);
    q.capture = &seen;
    const bool camera_known = pinhole_is_near(&c->camera);
    if (few) return solve_few(&q, camera_known, out);
    hypothesis near = {.light = calloc(count, sizeof *near.light)};
    hypothesis distant = {.light = calloc(count, sizeof *distant.light)};
    status s = near.light && distant.light ? OK : fail(MERLIN_NO_MEMORY, "no memory for %zu lights", count);
    if (s == OK) s = check_not_flat(&q);
    if (s == OK) s = find_by_fewer(&q, &near, &distant);
    if (s == OK) {
        const bool are_near = near.cost < clearly * distant.cost;
        const bool alone = are_near && camera_known && p->expected && p->expected->lights_alone;
        s = alone ? take_lights(&near, out) : solve_as(&q, are_near ? &near : &distant, camera_known, out);
        if (s == OK) out->lights_unsure = is_unsure(p, are_near ? &near : &distant, are_near);
        out->strengths_unsure = are_near ? near.uneven : distant.uneven;
    }
    free(near.light);
    free(distant.light);
    img_free(&near.depth);
    img_free(&distant.depth);
    return s;
}
