/* SPDX-License-Identifier: MIT */
/* Relighting by an environment: that of the next sample, in which the object is rendered again for its truth. */
#include <math.h>

#include "estimate/light/relight_env.h"
#include "estimate/surface/smooth.h"
#include "lab/eval/metrics.h"
#include "lab/eval/score_parts.h"
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
    eval_maps maps;
    status s = eval_maps_of_sample(again, &maps);
    if (s != OK) return s;
    bool same = eval_mse(&maps.albedo, &on->truth.albedo, &on->mask) < SAME_ALBEDO &&
                eval_mse(&maps.depth, &on->truth.depth, &on->mask) < SAME_DEPTH;
    eval_maps_free(&maps);
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
    if (fabsf(s->fov - SURFACE_FOV) > 0.01f)
        return fail(MERLIN_BAD_INPUT,
                    "sample %llu was rendered %g degrees wide: environments light what %g degrees show",
                    (unsigned long long)s->index, (double)s->fov, (double)SURFACE_FOV);
    o.seed = s->seed;
    o.image.size = s->mask.width;
    o.image.fov = s->fov;
    o.image.paths = PATHS;
    status st = render_sample_elsewhere(&o, s->index, s->index + 1, &again, &env);
    if (st != OK) return st;
    st = check_same(on, &again);
    if (st == OK) st = eval_picture(&again.env, NULL, &on->mask, &out->target);
    if (st == OK) st = env_map_new(&env.map, &out->env);
    sample_free(&again);
    environment_free(&env);
    if (st != OK) elsewhere_free(out);
    return st;
}

/* Estimated ones as merlin estimate gives them. */
static status surface_of(const eval_maps *maps, const img *mask, bool estimated, surface *out)
{
    *out = (surface){0};
    status s = img_copy(&out->albedo, &maps->albedo);
    if (s == OK) s = img_copy(&out->normal, &maps->normal);
    if (s == OK) s = img_copy(&out->roughness, &maps->roughness);
    if (s == OK) s = img_copy(&out->depth, &maps->depth);
    if (s == OK) s = img_copy(&out->mask, mask);
    if (s == OK && estimated) s = smooth_estimate(out);
    if (s == OK) {
        eval_to_file_range(&out->albedo);
        eval_to_file_range(&out->roughness);
        surface_tidy(out);
    } else {
        surface_free(out);
    }
    return s;
}

static status light_plainly(const surface *s, const env_map *env, img *lit)
{
    surface_add_ambient(s, (const float(*)[3])env->sh, lit);
    surface_add_reflections(s, env, NULL, lit);
    return OK;
}

static status light_with_shadows(const surface *s, const env_map *env, img *lit)
{
    shadow_caster caster;
    horizon h = {0};
    status st = shadow_caster_new(&s->depth, &s->normal, &s->mask, surface_lens(s), &caster);
    if (st != OK) return st;
    st = horizon_new(&caster, &h);
    if (st == OK) st = surface_add_shadowed_environment(s, s, &h, env, lit);
    horizon_free(&h);
    shadow_caster_free(&caster);
    return st;
}

typedef status lighting(const surface *s, const env_map *env, img *lit);

static status note_lit(eval_subject *on, const elsewhere *e, const surface *s, lighting *light, eval_row row,
                       eval_answer answer)
{
    img lit = {0}, picture = {0};
    status st = img_new(&lit, s->mask.width, s->mask.height, 3);
    if (st == OK) st = light(s, &e->env, &lit);
    if (st == OK) st = eval_picture(&lit, NULL, &on->mask, &picture);
    if (st == OK) st = eval_note_similarity(&on->scores, row, answer, &picture, &e->target);
    img_free(&lit);
    img_free(&picture);
    return st;
}

static status score_maps(eval_subject *on, const elsewhere *e, const eval_maps *maps, eval_answer answer)
{
    surface s;
    bool trivial = answer != EVAL_MODEL && answer != EVAL_TRUE_MAPS;
    status st = surface_of(maps, &on->mask, answer == EVAL_MODEL, &s);
    if (st != OK) return st;
    st = note_lit(on, e, &s, light_plainly, EVAL_ENVIRONMENT_BRDF, answer);
    if (st == OK && !trivial) st = note_lit(on, e, &s, light_with_shadows, EVAL_ENVIRONMENT_SHADOWS, answer);
    surface_free(&s);
    return st;
}

status eval_score_environment(eval_scorer *e, eval_subject *on)
{
    elsewhere there;
    status s = render_truth(on, &there);
    if (s != OK) return s;
    s = score_maps(on, &there, &e->prediction.maps, EVAL_MODEL);
    if (s == OK) s = score_maps(on, &there, &on->truth, EVAL_TRUE_MAPS);
    if (s == OK) s = score_maps(on, &there, &e->means.maps, EVAL_MEAN);
    if (s == OK) s = score_maps(on, &there, &on->inflated, EVAL_INFLATED);
    if (s == OK)
        s = eval_note_similarity(&on->scores, EVAL_ENVIRONMENT_BRDF, EVAL_UNCHANGED, &on->image, &there.target);
    eval_repeat_trivial(&on->scores, EVAL_ENVIRONMENT_BRDF, EVAL_ENVIRONMENT_SHADOWS);
    elsewhere_free(&there);
    return s;
}
