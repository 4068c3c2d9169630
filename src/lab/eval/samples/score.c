/* SPDX-License-Identifier: MIT */
#include "lab/eval/samples/score.h"

#include <string.h>

#include "estimate/light/shadow.h"
#include "lab/eval/metrics/metrics.h"
#include "lab/eval/samples/sheet.h"
#include "lab/eval/samples/truth.h"

/* ---- the photograph, and what the model makes of it ---- */

/* Takes the flash picture, of setting B in the sample's environment. */
static status take_photograph(const eval_scorer *e, eval_subject *on)
{
    const sample *s = on->sample;
    const model_config *config = eval_config(e);
    const bool in_surroundings = config->lighting == MODEL_LIGHT_BOTH;
    img radiance = {0};
    if (in_surroundings && !s->env.data)
        return fail(MERLIN_BAD_INPUT,
                    "model \"%s\" is for photographs in surroundings: render samples without --no-env", config->name);
    status st = img_copy(&radiance, &s->direct);
    if (st == OK && config->input_global) img_add(&s->indirect, &radiance);
    for (size_t i = 0; st == OK && in_surroundings && i < img_value_count(&radiance); i++)
        radiance.data[i] += EVAL_ENVIRONMENT_STRENGTH * s->env.data[i];
    if (st == OK) st = eval_photo_take(s, &radiance, e->raw ? &on->mask : &s->mask, e->white, &on->photo);
    if (st == OK) st = eval_picture(&radiance, NULL, &on->photo.mask, &on->image);
    img_free(&radiance);
    on->photo.params.views = e->views;
    return st;
}

static void give(const surface *truth, int set, merlin_maps *maps)
{
    const img *from[] = {&truth->albedo, &truth->normal, &truth->roughness, &truth->depth};
    merlin_image *to[] = {&maps->albedo, &maps->normal, &maps->roughness, &maps->depth};
    for (int i = 0; i < 4; i++)
        if (set & 1 << i) memcpy(to[i]->data, from[i]->data, img_value_count(from[i]) * sizeof(float));
}

static status estimate(const eval_scorer *e, eval_subject *on)
{
    status s = e->raw ? raw_estimate(e->model, &on->photo, e->views, &on->maps)
                      : eval_photo_estimate(e->model, &on->photo, &on->maps);
    if (s == OK && e->raw) s = raw_features(e->model, &on->photo, e->views, &on->features);
    if (s == OK) give(&on->truth, e->given, &on->maps);
    return s == OK ? eval_photo_surface(&on->photo, &on->maps, &on->found) : s;
}

/* ---- rows of the maps ---- */

static void score_maps(eval_subject *on, const surface *maps, eval_answer answer)
{
    const img *mask = &on->mask;
    const surface *truth = &on->truth;
    eval_note(&on->scores, EVAL_ALBEDO, answer, EVAL_UNIT * eval_mse(&maps->albedo, &truth->albedo, mask));
    eval_note(&on->scores, EVAL_NORMAL, answer, eval_mse(&maps->normal, &truth->normal, mask));
    eval_note(&on->scores, EVAL_ANGLE, answer, eval_angle(&maps->normal, &truth->normal, mask));
    eval_note(&on->scores, EVAL_DEPTH, answer, eval_mse(&maps->depth, &truth->depth, mask));
    eval_note(&on->scores, EVAL_ROUGHNESS, answer, EVAL_UNIT * eval_mse(&maps->roughness, &truth->roughness, mask));
}

static status score_reconstruction(eval_scorer *e, eval_subject *on)
{
    float sh[9][3];
    const illumination flash = {on->sample->light, eval_mean_surroundings(e, sh)};
    const eval_row row = EVAL_RECONSTRUCTION;
    status s = eval_score_picture(on, row, &on->maps.reconstruction, &on->image);
    if (s == OK) s = eval_score_trivial(on, &e->means.maps, EVAL_MEAN, row, &flash, &on->image);
    return s == OK ? eval_score_trivial(on, &on->inflated, EVAL_INFLATED, row, &flash, &on->image) : s;
}

static status score_light(eval_scorer *e, eval_subject *on)
{
    status s = OK;
    for (int i = 0; i < EVAL_LIGHTS && s == OK; i++) {
        const illumination light = {eval_light(on->sample, i), NULL};
        s = eval_score_rendered(e, on, &light, EVAL_RELIT_NETWORK, EVAL_RELIT_BRDF);
    }
    return s;
}

/* ---- rows of path-traced pictures ---- */

static status relight(eval_scorer *e, eval_subject *on, vec3 light, merlin_relighting how, merlin_image *out)
{
    float at[3];
    vec3_put(eval_photo_to_maps(&on->photo, &on->maps, light), at);
    return merlin_relight(e->model, &on->maps, at, how, out);
}

static status score_relighting(eval_scorer *e, eval_subject *on, vec3 light, const img *target)
{
    const eval_row rows[] = {[MERLIN_BY_BRDF] = EVAL_TRACED_SHADOWS,
                             [MERLIN_BY_NETWORK] = EVAL_TRACED_NETWORK,
                             [MERLIN_BY_BRDF_UNSHADOWED] = EVAL_TRACED_BRDF};
    status s = OK;
    for (int how = MERLIN_BY_BRDF; how <= MERLIN_BY_BRDF_UNSHADOWED && s == OK; how++) {
        merlin_image relit = {0};
        if (how == MERLIN_BY_NETWORK && eval_config(e)->relight != MODEL_RELIGHT_NETWORK) continue;
        s = relight(e, on, light, (merlin_relighting)how, &relit);
        if (s == OK) s = eval_score_picture(on, rows[how], &relit, target);
        merlin_image_free(&relit);
    }
    return s;
}

/* Scores the true maps under one light with the true indirect light: what relighting by BRDF itself leaves out. */
static status score_true_maps(eval_subject *on, const sample_target *t, const shadow_occluder *occluder,
                              const img *target)
{
    const eval_row rows[] = {EVAL_TRACED_BRDF, EVAL_TRACED_SHADOWS};
    img lit = {0}, seen = {0};
    status st = eval_render(&on->truth, &(illumination){t->light, NULL}, 1, &lit);
    if (st == OK) st = shadow_cast(occluder, t->light, lit.width, lit.height, &seen);
    for (int i = 0; st == OK && i < 2; i++) {
        img full = {0};
        if (i == 1) shadow_darken(&seen, &lit);
        st = eval_picture(&lit, &t->indirect, &on->photo.mask, &full);
        if (st == OK) st = eval_note_similarity(&on->scores, rows[i], EVAL_TRUE_MAPS, &full, target);
        img_free(&full);
    }
    img_free(&lit);
    img_free(&seen);
    return st;
}

static status score_target(eval_scorer *e, eval_subject *on, const sample_target *t, const shadow_occluder *occluder)
{
    img target = {0};
    status s = eval_picture(&t->direct, &t->indirect, &on->photo.mask, &target);
    if (s == OK) s = score_relighting(e, on, t->light, &target);
    if (s == OK) s = score_true_maps(on, t, occluder, &target);
    if (s == OK) s = eval_score_answers(e, on, EVAL_TRACED_BRDF, &(illumination){t->light, NULL}, &target);
    eval_repeat_trivial(&on->scores, EVAL_TRACED_BRDF, EVAL_TRACED_NETWORK);
    eval_repeat_trivial(&on->scores, EVAL_TRACED_BRDF, EVAL_TRACED_SHADOWS);
    img_free(&target);
    return s;
}

static status score_traced(eval_scorer *e, eval_subject *on)
{
    const sample *s = on->sample;
    const surface *truth = &on->truth;
    shadow_occluder occluder;
    if (s->target_count == 0) return OK;
    status st = shadow_occluder_new(&truth->depth, &truth->normal, &truth->mask, truth->lens, &occluder);
    if (st != OK) return st;
    /* lamps of relighting shine alike in all directions: there is no picture of them to compare an LED's with */
    for (int i = 0; i < s->target_count && st == OK; i++)
        if (!(s->targets[i].lobe > 0)) st = score_target(e, on, &s->targets[i], &occluder);
    shadow_occluder_free(&occluder);
    return st;
}

/* ---- all of them ---- */

static double saturated_share(const eval_subject *on)
{
    size_t saturated = 0, count = 0;
    for (size_t i = 0; i < img_value_count(&on->photo.picture); i++) {
        if (!(on->mask.data[i / 3] > 0)) continue;
        saturated += on->photo.picture.data[i] >= 1;
        count++;
    }
    return count ? (double)saturated / (double)count : 0;
}

static status show_relit(eval_scorer *e, eval_subject *on, vec3 light, merlin_relighting how, img *tile)
{
    merlin_image relit = {0};
    status s = relight(e, on, light, how, &relit);
    if (s == OK) s = eval_photo_radiance(&on->photo, &relit, tile);
    merlin_image_free(&relit);
    return s;
}

/* Fills a row of the sheet: what merlin_relight makes of the maps, beside the true maps rendered. */
static status show(eval_scorer *e, eval_subject *on)
{
    const vec3 light = eval_light(on->sample, 0);
    img *row = sheet_rows_begin(e->sheet);
    if (!row) return OK;
    status s = img_copy(&row[EVAL_SHEET_INPUT], &on->image);
    if (s == OK) s = eval_sheet_maps(&on->truth, &on->found, &on->mask, row);
    if (s == OK) s = eval_photo_radiance(&on->photo, &on->maps.reconstruction, &row[EVAL_SHEET_RECONSTRUCTION]);
    if (s == OK) s = eval_render(&on->truth, &(illumination){light, NULL}, 1, &row[EVAL_SHEET_RELIT_TRUE]);
    if (s == OK) s = show_relit(e, on, light, MERLIN_BY_BRDF_UNSHADOWED, &row[EVAL_SHEET_BY_BRDF]);
    if (s == OK)
        s = eval_config(e)->relight == MODEL_RELIGHT_NETWORK
                ? show_relit(e, on, light, MERLIN_BY_NETWORK, &row[EVAL_SHEET_BY_NETWORK])
                : img_new(&row[EVAL_SHEET_BY_NETWORK], on->mask.width, on->mask.height, 3);
    if (s == OK) sheet_rows_keep(e->sheet);
    return s;
}

static status score(eval_scorer *e, eval_subject *on)
{
    score_maps(on, &on->found, EVAL_MODEL);
    score_maps(on, &e->means.maps, EVAL_MEAN);
    score_maps(on, &on->inflated, EVAL_INFLATED);
    eval_score_regions(e, on);
    status s = score_reconstruction(e, on);
    if (s == OK) s = score_light(e, on);
    if (s == OK) s = score_traced(e, on);
    if (s == OK && eval_config(e)->lighting == MODEL_LIGHT_BOTH) s = eval_score_both_lights(e, on);
    if (s == OK && e->environments) {
        e->environments--;
        s = eval_score_environment(e, on);
    }
    on->scores.saturated = saturated_share(on);
    return s == OK && e->sheet ? show(e, on) : s;
}

static void subject_free(eval_subject *on)
{
    surface_free(&on->truth);
    surface_free(&on->inflated);
    surface_free(&on->found);
    merlin_maps_free(&on->maps);
    network_features_free(on->features);
    eval_photo_free(&on->photo);
    img_free(&on->image);
    img_free(&on->mask);
}

status eval_score_sample(eval_scorer *e, const sample *s, eval_scores *scores)
{
    eval_subject on = {.sample = s};
    status st = eval_binary_mask(&s->mask, &on.mask);
    if (st == OK) st = take_photograph(e, &on);
    if (st == OK) st = eval_truth(s, &on.photo.mask, &on.truth);
    if (st == OK) st = eval_inflate(&on.photo, &on.mask, &e->means, &on.inflated);
    if (st == OK) st = estimate(e, &on);
    if (st == OK) st = score(e, &on);
    *scores = on.scores;
    subject_free(&on);
    return st;
}
