/* SPDX-License-Identifier: MIT */
/* Estimates near lights of unknown position. Unlike distant ones they leave no ambiguity: their light falls off with
 * the squared distance, so that the gradient of brightness across a picture determines the light's position (T.
 * Papadhimitri, P. Favaro, Uncalibrated near-light photometric stereo, BMVC 2014, alternate light positions, normals
 * and depth). Here surface and lights are refined together, which converges where alternation is very slow (bundle.h).
 *
 * Priors: all lights have one power and about equal distances, and the scale is the camera's mean distance. The search
 * starts from several surfaces inflated from the object's outline, convex, flat or concave, on a coarse grid, each with
 * the lights that give the most similar pictures; the one that explains the pictures best, after misplaced lights have
 * been corrected, is refined on a finer grid. A bowl must do so clearly better than a convex surface. */
#include <math.h>
#include <stdlib.h>

#include "stereo/uncalibrated/bundle.h"
#include "stereo/uncalibrated/bundle_expected.h"
#include "stereo/uncalibrated/uncalibrated_parts.h"

/* Number of cells along the object; number of directions tried for a light, and of repetitions. */
enum { COARSE = 12, FINE = 22, DIRECTIONS = 240, SCANS = 4, RECALLS = 2 };
/* Limit of highlights in ordinary values while lights are searched. */
static const float bright = 1.5f;
/* Share of its cost to which a light's move must reduce it. */
static const double better = 0.95;

typedef struct start {
    float relief, distance; /* factor of an inflated outline's height; distance of lights in radii of the object */
    float handicap;         /* factor of its cost */
} start;

static const start starts[] = {{1, 2.5f, 1}, {0.3f, 2.5f, 1}, {1, 5, 1}, {0, 3, 1}, {-0.5f, 2.5f, 1.05f}};
enum { STARTS = sizeof starts / sizeof *starts };
/* Limit of a start's cost relative to the best: corrected lights lower the cost by up to a twentieth, so that a start
 * further behind stays there. */
static const double within_reach = 1.1;

/* Width of the loss, and number of steps at it. */
typedef struct pass {
    float width;
    int steps;
} pass;

static const pass coarse_pass[] = {{0.4f, 30}, {0.2f, 30}, {0.1f, 30}}, last_pass = {0.1f, 30};
static const pass fine_pass[] = {{0.15f, 20}, {0.08f, 30}};

/* Makes a bundle of one kind of lights, with its priors. */
static status new_bundle_of(bundle_kind kind, const pst_problem *p, const pinhole *camera, int across, bundle *out)
{
    status s = bundle_new(p, camera, across, out);
    out->kind = kind;
    if (s == OK) s = bundle_expect(out);
    if (s != OK) bundle_free(out);
    return s;
}

static status new_bundle(const pst_problem *p, const pinhole *camera, int across, bundle *out)
{
    return new_bundle_of(BUNDLE_NEAR, p, camera, across, out);
}

/* Returns a position on a spiral over the camera's side of the object and slightly beyond. */
static vec3 place(const bundle *b, int i, float distance)
{
    float z = 1 - 1.15f * ((float)i + 0.5f) / DIRECTIONS, across = sqrtf(fmaxf(1 - z * z, 0));
    float turn = 2.3999632f * (float)i;
    return vec3_fma(b->centre, distance * b->radius, vec3_make(across * cosf(turn), across * sinf(turn), z));
}

/* Returns the similarity of a picture to a light's shading of the surface, whatever its power; 1: equal. seen: one
 * value per cell. */
static float likeness(const bundle *b, int light, const float *seen)
{
    float product = 0, square = 1e-20f, own = 1e-20f;
    for (int i = 0; i < b->cells; i++) {
        size_t at = (size_t)i * (size_t)b->lights + (size_t)light;
        if (!(b->precision[at] > 0)) continue;
        float unit = 1 / b->cell[i].level, v = fminf(b->value[at] * unit, bright);
        float model = b->cell[i].albedo * fmaxf(seen[i], 0) * unit;
        product += model * v;
        square += model * model;
        own += v * v;
    }
    return product / sqrtf(square * own);
}

static void scan_lights(bundle *b, float distance, const float *seen)
{
    for (int k = 0; k < b->lights; k++) {
        float best = -1;
        for (int j = 0; j < DIRECTIONS; j++) {
            float like = likeness(b, k, seen + j * b->cells);
            if (like <= best) continue;
            best = like;
            b->position[k] = place(b, j, distance);
        }
    }
}

/* Finds the lights that give the most similar pictures; the surface's first albedo is that under uniform light. */
static status find_lights(bundle *b, float distance)
{
    float *seen = malloc((size_t)b->cells * DIRECTIONS * sizeof *seen);
    if (!seen) return fail(MERLIN_NO_MEMORY, "no memory for %d directions", DIRECTIONS);
    for (int i = 0; i < b->cells; i++) {
        float sum = 1e-6f;
        for (int j = 0; j < DIRECTIONS; j++) {
            float s = bundle_shading(b, i, place(b, j, distance));
            seen[j * b->cells + i] = s;
            sum += fmaxf(s, 0) / DIRECTIONS;
        }
        b->cell[i].albedo = b->cell[i].level / sum;
    }
    for (int scan = 0; scan < SCANS; scan++) {
        scan_lights(b, distance, seen);
        bundle_fit_albedo(b);
    }
    free(seen);
    return OK;
}

/* Searches again for lights that were misplaced while surface and albedo were wrong. */
static void recall_lights(bundle *b, float width)
{
    float distance = 0;
    for (int k = 0; k < b->lights; k++)
        distance += vec3_length(vec3_sub(b->position[k], b->centre)) / (b->radius * (float)b->lights);
    for (int k = 0; k < b->lights; k++) {
        double least = better * bundle_light_cost(b, k, b->position[k], width);
        for (int j = 0; j < DIRECTIONS; j++) {
            vec3 at = place(b, j, distance);
            double cost = bundle_light_cost(b, k, at, width);
            if (cost >= least) continue;
            least = cost;
            b->position[k] = at;
        }
    }
}

static status refine(bundle *b, const pass *passes, int count)
{
    status s = OK;
    for (int i = 0; i < count && s == OK; i++)
        s = bundle_refine(b, passes[i].width, passes[i].steps);
    return s;
}

/* Solves from what is expected. */
static status solve_expected(bundle *b)
{
    bundle_take_expected(b);
    bundle_fit_albedo(b);
    return refine(b, coarse_pass, sizeof coarse_pass / sizeof *coarse_pass);
}

/* Solves from a start. least: cost of the previous starts. */
static status solve_from(const start *from, double least, bundle *b)
{
    status s = bundle_inflate(b, from->relief);
    if (s == OK) s = find_lights(b, from->distance);
    if (s == OK) s = refine(b, coarse_pass, sizeof coarse_pass / sizeof *coarse_pass);
    for (int i = 0; i < RECALLS && s == OK && b->cost < within_reach * least; i++) {
        recall_lights(b, last_pass.width);
        s = refine(b, &last_pass, 1);
    }
    b->cost *= (double)from->handicap;
    return s;
}

static status solve_coarse(const pst_problem *p, const pinhole *camera, bundle *best)
{
    status s = new_bundle(p, camera, COARSE, best);
    if (s == OK) s = solve_from(&starts[0], HUGE_VAL, best);
    for (int i = 1; i < STARTS && s == OK; i++) {
        bundle trial;
        s = new_bundle(p, camera, COARSE, &trial);
        if (s == OK) s = solve_from(&starts[i], best->cost, &trial);
        bundle worse = trial;
        if (s == OK && trial.cost < best->cost) {
            worse = *best;
            *best = trial;
        }
        bundle_free(&worse);
    }
    return s;
}

/* Takes the solution from what is expected if it costs less. */
static status try_expected(const pst_problem *p, const pinhole *camera, bundle *best)
{
    bundle trial;
    status s = new_bundle(p, camera, COARSE, &trial);
    if (s == OK && trial.expected) s = solve_expected(&trial);
    bundle worse = trial;
    if (s == OK && trial.expected && (!best->problem || trial.cost < best->cost)) {
        worse = *best;
        *best = trial;
    }
    bundle_free(&worse);
    return s;
}

static status take_result(const bundle *b, merlin_light *light, img *depth)
{
    const pst_problem *p = b->problem;
    size_t width = (size_t)p->capture->width;
    status s = img_new(depth, p->capture->width, p->capture->height, 1);
    if (s != OK) return s;
    for (size_t i = 0; i < p->pixel_count; i++) {
        size_t column = p->pixel[i] % width, row = p->pixel[i] / width;
        depth->data[p->pixel[i]] = b->camera.distance * bundle_depth(b, (float)column + 0.5f, (float)row + 0.5f);
    }
    for (int k = 0; k < b->lights; k++) {
        light[k] = p->light[k];
        light[k].lobe = 0;
        vec3_put(vec3_scale(b->position[k], b->camera.distance), light[k].position);
        vec3_put(vec3_normalize(vec3_sub(b->position[k], b->centre)), light[k].direction);
    }
    return OK;
}

/* Returns the mean cost of the values alone. */
static double cost_of_value(const bundle *b)
{
    double sum = 0;
    for (int k = 0; k < b->lights; k++)
        sum += bundle_light_cost(b, k, b->position[k], last_pass.width);
    return sum / ((double)b->cells * b->lights);
}

/* Refines what was found on a finer grid, and stores it. */
static status refine_fine(bundle *fine, const bundle *coarse, merlin_light *light, img *depth, pst_near_bend *bend)
{
    bundle_take(fine, coarse);
    bundle_fit_albedo(fine);
    status s = refine(fine, fine_pass, sizeof fine_pass / sizeof *fine_pass);
    if (s == OK) s = take_result(fine, light, depth);
    if (s == OK && bend) s = bundle_bend_normals(fine, &bend->normal);
    if (s == OK && bend) bend->cost_of_value = cost_of_value(fine);
    return s;
}

status pst_find_near_lights(const pst_problem *p, const pinhole *camera, merlin_light *light, img *depth,
                            pst_near_bend *bend)
{
    bundle coarse = {0}, fine = {0};
    /* fewer pictures are explained by any surface */
    status s = p->capture->count >= PST_FEWEST_UNKNOWN ? solve_coarse(p, camera, &coarse) : OK;
    if (s == OK) s = try_expected(p, camera, &coarse);
    if (s == OK) s = new_bundle(p, camera, FINE, &fine);
    if (s == OK) s = refine_fine(&fine, &coarse, light, depth, bend);
    bundle_free(&coarse);
    bundle_free(&fine);
    return s;
}

status pst_find_lights_afar(const pst_problem *p, const pinhole *camera, bool equal, merlin_light *light, img *depth,
                            pst_near_bend *bend)
{
    const bundle_kind kind = equal ? BUNDLE_DISTANT_EQUAL : BUNDLE_DISTANT_FREE;
    bundle coarse = {0}, fine = {0};
    status s = new_bundle_of(kind, p, camera, COARSE, &coarse);
    if (s == OK) s = solve_expected(&coarse);
    if (s == OK) s = new_bundle_of(kind, p, camera, FINE, &fine);
    if (s == OK) s = refine_fine(&fine, &coarse, light, depth, bend);
    bundle_free(&coarse);
    bundle_free(&fine);
    return s;
}
