/* SPDX-License-Identifier: MIT */
#include "lab/eval/score_parts.h"

status eval_score_trivial(eval_subject *on, const eval_maps *maps, eval_answer answer, eval_row row,
                          const illumination *light, const img *target)
{
    img lit;
    const sample *s = on->sample;
    status st = eval_render(maps, &on->mask, s->fov, s->light_power, light, &lit);
    if (st != OK) return st;
    st = eval_note_similarity(&on->scores, row, answer, &lit, target);
    img_free(&lit);
    return st;
}

status eval_score_relighting(eval_scorer *e, eval_subject *on, const eval_relighting *r, eval_row decoder,
                             eval_row brdf, const img *by_network, const img *by_brdf)
{
    status s = OK;
    for (int i = 0; s == OK && i < r->count; i++) {
        const img *target = &r->targets[i];
        const illumination *light = &r->lights[i];
        if (eval_model_relights(e->model))
            s = eval_note_similarity(&on->scores, decoder, EVAL_MODEL, &by_network[i], target);
        if (s == OK) s = eval_note_similarity(&on->scores, brdf, EVAL_MODEL, &by_brdf[i], target);
        if (s == OK) s = eval_score_trivial(on, &e->means.maps, EVAL_MEAN, brdf, light, target);
        if (s == OK) s = eval_score_trivial(on, &on->inflated, EVAL_INFLATED, brdf, light, target);
        if (s == OK) s = eval_note_similarity(&on->scores, brdf, EVAL_UNCHANGED, &on->image, target);
    }
    eval_repeat_trivial(&on->scores, brdf, decoder);
    return s;
}

void eval_relighting_free(eval_relighting *r)
{
    for (int i = 0; i < EVAL_LIGHTS; i++)
        img_free(&r->targets[i]);
}

status eval_render_targets(const eval_subject *on, eval_relighting *r)
{
    const sample *s = on->sample;
    status st = OK;
    for (int i = 0; i < r->count && st == OK; i++)
        st = eval_render(&on->truth, &on->mask, s->fov, s->light_power, &r->lights[i], &r->targets[i]);
    if (st != OK) eval_relighting_free(r);
    return st;
}
