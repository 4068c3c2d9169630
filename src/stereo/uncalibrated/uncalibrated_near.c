/* SPDX-License-Identifier: MIT */
/* Estimates near lights of unknown position. Unlike distant ones they leave no ambiguity: their light falls off with
 * the squared distance, so that the gradient of brightness across a picture determines the light's position (T.
 * Papadhimitri, P. Favaro, Uncalibrated near-light photometric stereo, BMVC 2014, alternate light positions, normals
 * and depth). Here surface and lights are refined together, which converges where alternation is very slow (bundle.h).
 *
 * Priors: all lights have one power and about equal distances, and the scale is the camera's mean distance. The search
 * starts from several surfaces inflated from the object's outline, convex, flat or concave, on a coarse grid, each with
 * the lights that give the most similar pictures; the one that explains the pictures best, after misplaced lights have
 * been corrected, is refined on a finer grid. A bowl must do so clearly better than a convex surface. From seven
 * pictures on, lights of any power, as a camera's automatic exposure makes them, are tried from there, and must explain
 * the pictures better than chance makes them. */
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

/* Ratio of costs from which on lights are not of one strength. Measured of two to six pictures of a cat, an owl and a
 * ball under distant lights: 1.06 to 1.26 as they were (1.6 of two of the ball), 1.5 to 4.3 exposed up to 2.5 times as
 * much as others. Of fourteen rendered objects under near lights, 8 or 16 pictures and PLENTY or more: up to 1.11 and
 * 1.09 as they were, 1.0 to 1.28 and 1.05 to 1.41 exposed so; less than that costs little. */
enum { PLENTY = 24 };
static const double far_better = 1.5, better_of_some = 1.13, better_of_plenty = 1.09;

/* Width of the loss, and number of steps at it. */
typedef struct pass {
    float width;
    int steps;
} pass;

static const pass coarse_pass[] = {{0.4f, 30}, {0.2f, 30}, {0.1f, 30}}, last_pass = {0.1f, 30};
static const pass fine_pass[] = {{0.15f, 20}, {0.08f, 30}};

/* Makes a bundle with its priors. */
static status new_bundle(const pst_problem *p, const pinhole *camera, bundle_kind kind, int across, bundle *out)
{
    status s = bundle_new(p, camera, kind, across, out);
    if (s == OK) s = bundle_expect(out);
    if (s != OK) bundle_free(out);
    return s;
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

/* Refines and, unless the cost is out of reach of a lower one, corrects misplaced lights. */
static status refine_coarse(bundle *b, double least)
{
    status s = refine(b, coarse_pass, sizeof coarse_pass / sizeof *coarse_pass);
    for (int i = 0; i < RECALLS && s == OK && b->cost < within_reach * least; i++) {
        recall_lights(b, last_pass.width);
        s = refine(b, &last_pass, 1);
    }
    return s;
}

/* Solves from a start. least: cost of the previous starts. */
static status solve_from(const start *from, double least, bundle *b)
{
    status s = bundle_inflate(b, from->relief);
    if (s == OK) s = find_lights(b, from->distance);
    if (s == OK) s = refine_coarse(b, least);
    b->cost *= (double)from->handicap;
    return s;
}

/* Keeps the trial if it is the better one, and frees the other. */
static void keep_better(bundle *best, bundle *trial, bool is_better)
{
    const bundle worse = is_better ? *best : *trial;
    if (is_better) *best = *trial;
    *trial = worse;
    bundle_free(trial);
}

static status solve_coarse(const pst_problem *p, const pinhole *camera, bundle *best)
{
    status s = new_bundle(p, camera, BUNDLE_NEAR_EQUAL, COARSE, best);
    if (s == OK) s = solve_from(&starts[0], HUGE_VAL, best);
    for (int i = 1; i < STARTS && s == OK; i++) {
        bundle trial;
        s = new_bundle(p, camera, BUNDLE_NEAR_EQUAL, COARSE, &trial);
        if (s == OK) s = solve_from(&starts[i], best->cost, &trial);
        keep_better(best, &trial, s == OK && trial.cost < best->cost);
    }
    return s;
}

/* Takes the solution from what is expected if it costs less. */
static status try_expected(const pst_problem *p, const pinhole *camera, bundle *best)
{
    bundle trial;
    status s = new_bundle(p, camera, BUNDLE_NEAR_EQUAL, COARSE, &trial);
    if (s == OK && trial.expected) s = solve_expected(&trial);
    keep_better(best, &trial, s == OK && trial.expected && (!best->problem || trial.cost < best->cost));
    return s;
}

/* Returns the mean cost of the values alone. */
static double cost_of_value(const bundle *b)
{
    double sum = 0;
    for (int k = 0; k < b->lights; k++)
        sum += bundle_light_cost(b, k, b->position[k], last_pass.width);
    return sum / ((double)b->cells * b->lights);
}

/* Takes lights of any strength if they explain the pictures better than by chance. */
static status try_free(const pst_problem *p, const pinhole *camera, bundle *best)
{
    const int count = p->capture->count;
    const double better_by = count < PLENTY ? better_of_some : better_of_plenty;
    bundle trial;
    if (count < PST_FEWEST_UNKNOWN) return OK;
    status s = new_bundle(p, camera, BUNDLE_NEAR_FREE, COARSE, &trial);
    if (s != OK) return s;
    bundle_take(&trial, best);
    bundle_fit_strengths(&trial);
    s = refine_coarse(&trial, HUGE_VAL);
    keep_better(best, &trial, s == OK && cost_of_value(best) > better_by * cost_of_value(&trial));
    return s;
}

static float mean_strength(const bundle *b)
{
    float sum = 0;
    for (int k = 0; k < b->lights; k++)
        sum += b->strength[k] / (float)b->lights;
    return sum;
}

static status take_result(const bundle *b, pst_near_found *out)
{
    const pst_problem *p = b->problem;
    const size_t width = (size_t)p->capture->width;
    const float unit = 1 / mean_strength(b);
    out->uneven = b->kind == BUNDLE_NEAR_FREE || b->kind == BUNDLE_DISTANT_FREE;
    out->cost_of_value = cost_of_value(b);
    out->light = calloc((size_t)p->capture->count, sizeof *out->light);
    if (!out->light) return fail(MERLIN_NO_MEMORY, "no memory for %d lights", b->lights);
    for (int k = 0; k < b->lights; k++) {
        merlin_light *light = &out->light[k];
        *light = p->light[k];
        light->lobe = 0;
        for (int ch = 0; ch < 3; ch++)
            light->intensity[ch] *= unit * b->strength[k];
        vec3_put(vec3_scale(b->position[k], b->camera.distance), light->position);
        vec3_put(vec3_normalize(vec3_sub(b->position[k], b->centre)), light->direction);
    }
    status s = img_new(&out->depth, p->capture->width, p->capture->height, 1);
    for (size_t i = 0; i < p->pixel_count && s == OK; i++) {
        const size_t column = p->pixel[i] % width, row = p->pixel[i] / width;
        out->depth.data[p->pixel[i]] = b->camera.distance * bundle_depth(b, (float)column + 0.5f, (float)row + 0.5f);
    }
    return s == OK && b->expected ? bundle_bend_normals(b, &out->bent) : s;
}

/* Refines what was found on a finer grid, and stores it. */
static status refine_fine(const bundle *coarse, pst_near_found *out)
{
    bundle fine;
    status s = new_bundle(coarse->problem, &coarse->camera, coarse->kind, FINE, &fine);
    if (s != OK) return s;
    bundle_take(&fine, coarse);
    bundle_fit_albedo(&fine);
    s = refine(&fine, fine_pass, sizeof fine_pass / sizeof *fine_pass);
    if (s == OK) s = take_result(&fine, out);
    bundle_free(&fine);
    return s;
}

void pst_near_found_free(pst_near_found *f)
{
    free(f->light);
    img_free(&f->depth);
    img_free(&f->bent);
}

status pst_find_near_lights(const pst_problem *p, const pinhole *camera, pst_near_found *out)
{
    bundle coarse = {0};
    *out = (pst_near_found){0};
    /* fewer pictures are explained by any surface */
    status s = p->capture->count >= PST_FEWEST_UNKNOWN ? solve_coarse(p, camera, &coarse) : OK;
    if (s == OK) s = try_expected(p, camera, &coarse);
    if (s == OK) s = try_free(p, camera, &coarse);
    if (s == OK) s = refine_fine(&coarse, out);
    bundle_free(&coarse);
    return s;
}

static status find_afar(const pst_problem *p, const pinhole *camera, bundle_kind kind, pst_near_found *out)
{
    bundle coarse;
    *out = (pst_near_found){0};
    status s = new_bundle(p, camera, kind, COARSE, &coarse);
    if (s != OK) return s;
    s = solve_expected(&coarse);
    if (s == OK) s = refine_fine(&coarse, out);
    bundle_free(&coarse);
    return s;
}

status pst_find_lights_afar(const pst_problem *p, const pinhole *camera, pst_near_found *out)
{
    pst_near_found other = {0};
    status s = find_afar(p, camera, BUNDLE_DISTANT_EQUAL, out);
    if (s == OK) s = find_afar(p, camera, BUNDLE_DISTANT_FREE, &other);
    if (s == OK && out->cost_of_value > far_better * other.cost_of_value) {
        const pst_near_found worse = *out;
        *out = other;
        other = worse;
    }
    pst_near_found_free(&other);
    return s;
}
