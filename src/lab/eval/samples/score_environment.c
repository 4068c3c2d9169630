/* SPDX-License-Identifier: MIT */
/* Relighting by an environment: that of the next sample, in which the object is rendered again for its truth. */
#include <math.h>

#include "estimate/light/relight_env.h"
#include "estimate/relight/relighter.h"
#include "lab/eval/metrics/metrics.h"
#include "lab/eval/samples/score_parts.h"
#include "lab/eval/samples/truth.h"
#include "lab/render/generate.h"

/* Four times what samples are made with: their grain costs more similarity than shadows bring. */
enum { PATHS = 32 };
/* Mean squared differences of albedo, [-1, 1], and depth below which two samples show one object: one ray a pixel
 * instead of 16 leaves 0.02 and 0.0004, two objects differ by 0.15 and 0.1 at least (six of seed 1, 64 and 256 pixels).
 */
static const double SAME_ALBEDO = 0.06, SAME_DEPTH = 0.01;

/* The object's truth there, and what lights it. */
typedef struct elsewhere {
    img target;
    env_map env;
} elsewhere;

static void elsewhere_free(elsewhere *e)
{
    img_free(&e->target);
    env_map_free(&e->env);
}

static status check_same(const eval_subject *on, const sample *again)
{
    bool same = EVAL_UNIT * eval_mse(&again->albedo, &on->truth.albedo, &on->mask) < SAME_ALBEDO &&
                eval_mse(&again->depth, &on->truth.depth, &on->mask) < SAME_DEPTH;
    return same ? OK
                : fail(MERLIN_BAD_INPUT,
                       "sample %llu of seed %llu is not what merlin-lab render makes of these numbers (a mesh, other "
                       "materials or another version): it cannot be relit by environments",
                       (unsigned long long)on->sample->index, (unsigned long long)on->sample->seed);
}

static status render_truth(const eval_subject *on, elsewhere *out)
{
    const sample *s = on->sample;
    render_options o = render_options_default();
    sample again;
    environment env;
    *out = (elsewhere){0};
    if (fabsf(s->fov - CAMERA_FOV) > 0.01f)
        return fail(MERLIN_BAD_INPUT,
                    "sample %llu was rendered %g degrees wide: environments light what %g degrees show",
                    (unsigned long long)s->index, (double)s->fov, (double)CAMERA_FOV);
    o.seed = s->seed;
    o.image.size = s->mask.width;
    o.image.fov = s->fov;
    o.image.paths = PATHS;
    status st = render_sample_elsewhere(&o, s->index, s->index + 1, &again, &env);
    if (st != OK) return st;
    st = check_same(on, &again);
    if (st == OK) st = eval_picture(&again.env, NULL, &on->photo.mask, &out->target);
    if (st == OK) st = env_map_new(&env.map, &out->env);
    sample_free(&again);
    environment_free(&env);
    if (st != OK) elsewhere_free(out);
    return st;
}

/* ---- the model, as merlin relight --env has it ---- */

static status score_model(eval_scorer *e, eval_subject *on, const elsewhere *there, merlin_relighting how, eval_row row)
{
    const merlin_environment around = {.map = there->env};
    merlin_image relit = {0};
    status s = merlin_relight_environment(e->model, &on->maps, &around, NULL, how, &relit);
    if (s == OK) s = eval_score_picture(on, row, &relit, &there->target);
    merlin_image_free(&relit);
    return s;
}

/* ---- maps that no model made ---- */

static status light_plainly(const surface *s, const env_map *env, img *lit)
{
    surface_add_ambient(s, (const float(*)[3])env->sh, lit);
    surface_add_reflections(s, env, NULL, lit);
    return OK;
}

static status light_with_shadows(const surface *s, const env_map *env, img *lit)
{
    shadow_occluder occluder;
    horizon h = {0};
    status st = shadow_occluder_new(&s->depth, &s->normal, &s->mask, surface_lens(s), &occluder);
    if (st != OK) return st;
    st = horizon_new(&occluder, &h);
    if (st == OK) st = surface_add_shadowed_environment(s, s, &h, env, lit);
    horizon_free(&h);
    shadow_occluder_free(&occluder);
    return st;
}

typedef status lighting(const surface *s, const env_map *env, img *lit);

static status note_lit(eval_subject *on, const elsewhere *there, const surface *maps, lighting *light, eval_row row,
                       eval_answer answer)
{
    surface tidy = {0};
    img lit = {0}, picture = {0};
    const surface shown = eval_shown(on, maps);
    status s = surface_resize(&shown, &shown.mask, &tidy);
    if (s == OK) s = img_new(&lit, tidy.mask.width, tidy.mask.height, 3);
    if (s == OK) s = light(&tidy, &there->env, &lit);
    if (s == OK) s = eval_picture(&lit, NULL, &on->photo.mask, &picture);
    if (s == OK) s = eval_note_similarity(&on->scores, row, answer, &picture, &there->target);
    surface_free(&tidy);
    img_free(&lit);
    img_free(&picture);
    return s;
}

status eval_score_environment(eval_scorer *e, eval_subject *on)
{
    const eval_row plain = EVAL_ENVIRONMENT_BRDF, shadowed = EVAL_ENVIRONMENT_SHADOWS;
    elsewhere there;
    status s = render_truth(on, &there);
    if (s != OK) return s;
    s = score_model(e, on, &there, MERLIN_BY_BRDF_UNSHADOWED, plain);
    if (s == OK) s = score_model(e, on, &there, MERLIN_BY_BRDF, shadowed);
    if (s == OK) s = note_lit(on, &there, &on->truth, light_plainly, plain, EVAL_TRUE_MAPS);
    if (s == OK) s = note_lit(on, &there, &on->truth, light_with_shadows, shadowed, EVAL_TRUE_MAPS);
    if (s == OK) s = note_lit(on, &there, &e->means.maps, light_plainly, plain, EVAL_MEAN);
    if (s == OK) s = note_lit(on, &there, &on->inflated, light_plainly, plain, EVAL_INFLATED);
    if (s == OK) s = eval_note_similarity(&on->scores, plain, EVAL_UNCHANGED, &on->image, &there.target);
    eval_repeat_trivial(&on->scores, plain, shadowed);
    elsewhere_free(&there);
    return s;
}
