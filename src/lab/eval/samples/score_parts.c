/* SPDX-License-Identifier: MIT */
#include "lab/eval/samples/score_parts.h"

#include "lab/eval/samples/truth.h"

status eval_score_trivial(eval_subject *on, const surface *maps, eval_answer answer, eval_row row,
                          const illumination *light, const img *target)
{
    img lit = {0};
    const surface shown = eval_shown(on, maps);
    status st = eval_render(&shown, light, 1, &lit);
    if (st == OK) st = eval_note_similarity(&on->scores, row, answer, &lit, target);
    img_free(&lit);
    return st;
}

status eval_score_picture(eval_subject *on, eval_row row, const merlin_image *picture, const img *target)
{
    img radiance = {0};
    status s = eval_photo_radiance(&on->photo, picture, &radiance);
    if (s == OK) s = eval_note_similarity(&on->scores, row, EVAL_MODEL, &radiance, target);
    img_free(&radiance);
    return s;
}

status eval_score_answers(const eval_scorer *e, eval_subject *on, eval_row row, const illumination *light,
                          const img *target)
{
    status s = eval_score_trivial(on, &e->means.maps, EVAL_MEAN, row, light, target);
    if (s == OK) s = eval_score_trivial(on, &on->inflated, EVAL_INFLATED, row, light, target);
    return s == OK ? eval_note_similarity(&on->scores, row, EVAL_UNCHANGED, &on->image, target) : s;
}

static status score_decoder(eval_scorer *e, eval_subject *on, const illumination *light, eval_row row,
                            const img *target)
{
    img relit = {0};
    if (!on->features) return OK;
    status s = network_relight(e->model->network, on->features, light, &relit);
    if (s == OK) s = eval_note_similarity(&on->scores, row, EVAL_MODEL, &relit, target);
    img_free(&relit);
    return s;
}

status eval_score_rendered(eval_scorer *e, eval_subject *on, const illumination *light, eval_row decoder, eval_row brdf)
{
    img target = {0}, lit = {0};
    status s = eval_render(&on->truth, light, 1, &target);
    if (s == OK) s = eval_render(&on->found, light, eval_exposure(on), &lit);
    if (s == OK) s = eval_note_similarity(&on->scores, brdf, EVAL_MODEL, &lit, &target);
    if (s == OK) s = score_decoder(e, on, light, decoder, &target);
    if (s == OK) s = eval_score_answers(e, on, brdf, light, &target);
    if (s == OK && e->raw) eval_repeat_trivial(&on->scores, brdf, decoder);
    img_free(&target);
    img_free(&lit);
    return s;
}
