/* SPDX-License-Identifier: MIT */
#include "lab/eval/score.h"

#include "estimate/light/shadow.h"
#include "lab/eval/metrics.h"

static void score_maps(eval_subject *on, const eval_maps *maps, eval_answer answer)
{
    const img *mask = &on->mask;
    eval_note(&on->scores, EVAL_ALBEDO, answer, eval_mse(&maps->albedo, &on->truth.albedo, mask));
    eval_note(&on->scores, EVAL_NORMAL, answer, eval_mse(&maps->normal, &on->truth.normal, mask));
    eval_note(&on->scores, EVAL_ANGLE, answer, eval_angle(&maps->normal, &on->truth.normal, mask));
    eval_note(&on->scores, EVAL_DEPTH, answer, eval_mse(&maps->depth, &on->truth.depth, mask));
    eval_note(&on->scores, EVAL_ROUGHNESS, answer, eval_mse(&maps->roughness, &on->truth.roughness, mask));
}

static status score_reconstruction(eval_scorer *e, eval_subject *on)
{
    float sh[9][3];
    illumination flash = {on->sample->light, eval_mean_surroundings(e, sh)};
    status s =
        eval_note_similarity(&on->scores, EVAL_RECONSTRUCTION, EVAL_MODEL, &e->prediction.reconstruction, &on->image);
    if (s == OK) s = eval_score_trivial(on, &e->means.maps, EVAL_MEAN, EVAL_RECONSTRUCTION, &flash, &on->image);
    if (s == OK) s = eval_score_trivial(on, &on->inflated, EVAL_INFLATED, EVAL_RECONSTRUCTION, &flash, &on->image);
    return s;
}

/* The sample's path-traced targets from `first` on; a last group that is not full repeats its first light. */
static status relight_by_tracing(const eval_subject *on, int first, eval_relighting *r)
{
    const sample *s = on->sample;
    int left = s->target_count - first;
    *r = (eval_relighting){.count = left < EVAL_LIGHTS ? left : EVAL_LIGHTS};
    for (int i = 0; i < EVAL_LIGHTS; i++) {
        const sample_target *target = &s->targets[first + (i < r->count ? i : 0)];
        r->lights[i].place = target->light;
        status st = i < r->count ? eval_picture(&target->direct, &target->indirect, &on->mask, &r->targets[i]) : OK;
        if (st != OK) {
            eval_relighting_free(r);
            return st;
        }
    }
    return OK;
}

static status score_brdf_targets(eval_scorer *e, eval_subject *on)
{
    eval_relighting r = {.count = EVAL_LIGHTS};
    for (int i = 0; i < EVAL_LIGHTS; i++)
        r.lights[i].place = eval_light(on->sample, i);
    status s = eval_render_targets(on, &r);
    if (s != OK) return s;
    s = eval_relight(e->model, &on->mask, r.lights, &e->prediction);
    if (s == OK) {
        score_maps(on, &e->prediction.maps, EVAL_MODEL);
        score_maps(on, &e->means.maps, EVAL_MEAN);
        score_maps(on, &on->inflated, EVAL_INFLATED);
        eval_score_regions(e, on);
        s = score_reconstruction(e, on);
    }
    if (s == OK)
        s = eval_score_relighting(e, on, &r, EVAL_RELIT_NETWORK, EVAL_RELIT_BRDF, e->prediction.by_network,
                                  e->prediction.by_brdf);
    if (s == OK && e->sheet)
        s = eval_sheet_add(e->sheet, &on->image, &on->mask, &on->truth, &e->prediction, &r.targets[0]);
    eval_relighting_free(&r);
    return s;
}

/* The true maps under one light with the true indirect light: what relighting by BRDF itself leaves out. */
static status score_true_maps(eval_subject *on, const sample_target *t, const shadow_caster *caster, const img *target)
{
    const sample *s = on->sample;
    const eval_row rows[] = {EVAL_TRACED_BRDF, EVAL_TRACED_SHADOWS};
    img lit = {0}, seen = {0};
    status st = eval_render(&on->truth, &on->mask, s->fov, s->light_power, &(illumination){t->light, NULL}, &lit);
    if (st == OK) st = shadow_cast(caster, t->light, lit.width, lit.height, &seen);
    for (int i = 0; st == OK && i < 2; i++) {
        img full = {0};
        if (i == 1) shadow_darken(&seen, &lit);
        st = eval_picture(&lit, &t->indirect, &on->mask, &full);
        if (st == OK) st = eval_note_similarity(&on->scores, rows[i], EVAL_TRUE_MAPS, &full, target);
        img_free(&full);
    }
    img_free(&lit);
    img_free(&seen);
    return st;
}

static status score_shadows(eval_scorer *e, eval_subject *on, int first, const eval_relighting *r)
{
    const eval_maps *truth = &on->truth;
    shadow_caster caster;
    status s = eval_relight_shadows(e->model, &on->mask, on->sample->fov, r->lights, &e->prediction);
    if (s == OK)
        s = shadow_caster_new(&truth->depth, &truth->normal, &on->mask, (camera_lens){.fov = on->sample->fov}, &caster);
    if (s != OK) return s;
    for (int i = 0; s == OK && i < r->count; i++) {
        const img *target = &r->targets[i];
        s = eval_note_similarity(&on->scores, EVAL_TRACED_SHADOWS, EVAL_MODEL, &e->prediction.shadowed[i], target);
        if (s == OK) s = score_true_maps(on, &on->sample->targets[first + i], &caster, target);
    }
    eval_repeat_trivial(&on->scores, EVAL_TRACED_BRDF, EVAL_TRACED_SHADOWS);
    shadow_caster_free(&caster);
    return s;
}

static status score_traced_targets(eval_scorer *e, eval_subject *on)
{
    status s = OK;
    for (int first = 0; s == OK && first < on->sample->target_count; first += EVAL_LIGHTS) {
        eval_relighting r;
        s = relight_by_tracing(on, first, &r);
        if (s != OK) return s;
        s = eval_relight(e->model, &on->mask, r.lights, &e->prediction);
        if (s == OK)
            s = eval_score_relighting(e, on, &r, EVAL_TRACED_NETWORK, EVAL_TRACED_BRDF, e->prediction.full_by_network,
                                      e->prediction.full_by_brdf);
        if (s == OK) s = score_shadows(e, on, first, &r);
        eval_relighting_free(&r);
    }
    return s;
}

/* What the network is shown: the flash picture, for models of setting B in the sample's environment. */
static status take_photograph(const eval_scorer *e, eval_subject *on)
{
    const sample *s = on->sample;
    const model_config *config = eval_model_config(e->model);
    img more = {0};
    if (config->lighting != MODEL_LIGHT_BOTH)
        return eval_photograph(&s->direct, config->input_global ? &s->indirect : NULL, &on->mask, e->white, &on->photo);
    if (!s->env.data)
        return fail(MERLIN_BAD_INPUT,
                    "model \"%s\" is for photographs in surroundings: render samples without --no-env", config->name);
    status st = img_copy(&more, &s->env);
    if (st != OK) return st;
    for (size_t i = 0, n = 3 * (size_t)more.width * (size_t)more.height; i < n; i++)
        more.data[i] = EVAL_ENVIRONMENT_STRENGTH * more.data[i] + (config->input_global ? s->indirect.data[i] : 0);
    st = eval_photograph(&s->direct, &more, &on->mask, e->white, &on->photo);
    img_free(&more);
    return st;
}

static double saturated_share(const img *photo, const img *mask, float white)
{
    size_t saturated = 0, count = 0, pixels = (size_t)mask->width * (size_t)mask->height;
    for (size_t i = 0; i < 3 * pixels; i++) {
        if (mask->data[i / 3] <= EVAL_MASK_LEVEL) continue;
        saturated += photo->data[i] >= white;
        count++;
    }
    return count ? (double)saturated / (double)count : 0;
}

status eval_score_sample(eval_scorer *e, const sample *s, eval_scores *scores)
{
    eval_subject on = {.sample = s};
    status st = eval_binary_mask(&s->mask, &on.mask);
    if (st == OK) st = take_photograph(e, &on);
    if (st == OK) st = eval_picture(&on.photo, NULL, &on.mask, &on.image);
    if (st == OK) st = eval_maps_of_sample(s, &on.truth);
    if (st == OK) st = eval_inflate(&on.photo, &on.mask, &e->means, s->fov, s->light_power, &on.inflated);
    if (st == OK) st = eval_estimate(e->model, &on.photo, &on.mask, &e->prediction);
    if (st == OK) eval_maps_take(&on.truth, e->given, &e->prediction.maps);
    if (st == OK) st = score_brdf_targets(e, &on);
    if (st == OK) st = score_traced_targets(e, &on);
    if (st == OK && eval_model_config(e->model)->lighting == MODEL_LIGHT_BOTH) st = eval_score_both_lights(e, &on);
    if (st == OK && e->environments) {
        e->environments--;
        st = eval_score_environment(e, &on);
    }
    if (st == OK) on.scores.saturated = saturated_share(&on.photo, &on.mask, e->white);
    *scores = on.scores;
    eval_maps_free(&on.truth);
    eval_maps_free(&on.inflated);
    img_free(&on.photo);
    img_free(&on.image);
    img_free(&on.mask);
    return st;
}
