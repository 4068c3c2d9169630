/* SPDX-License-Identifier: MIT */
#include "stereo/fit/lobe_choice.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Shares of the loss that a choice must explain; smaller ones count as chance. */
static const double worth_kind = 0.02, worth_view = 0.05, worth_terminator = 0.1;

/* The terminator that is tried first, closer than 0 to all usual ones. */
static const float likely_terminator = 0.07f;

/* Share of the loss that a second lobe must save. */
static const double worth_second = 0.1;

/* Shares of the prediction error that a lobe, or another width, must save; smaller ones count as chance. */
static const double worth_freedom = 0.03, worth_width = 0.015;

/* Share that a terminator must save: a rough matte surface saves 6 percent with one that it does not have, a raised
 * black level 70 with its own. */
static const double worth_dark = 0.3;

/* Least number of lights: with fewer τ and the lobe's kind would be fitted to the shadows. */
enum { FEWEST_LIGHTS = 12 };

/* Least number of lights for cross-validation, as a quarter is held out. */
enum { PREDICTING_LIGHTS = 8 };

typedef struct kind {
    float masking;
    int tail;
} kind;

/* Kinds to try, the plain choice first; those that differ from the others are fitted without a start. */
static const kind kinds[] = {{0.28f, 2}, {1, 8}, {1, 2}, {1, 4}, {0.28f, 8}};
enum { UNLIKE = 2, KINDS = sizeof kinds / sizeof *kinds };

typedef struct choice {
    pst_field field; /* lobe: the one that is tried */
    pst_lobe best, trial;
    pst_shading *kept; /* shading of the best one */
    double cost;
    status status;
} choice;

/* Tries a lobe, and keeps it if it saves more than a share of the cost. anew: fit without a start. */
static void attempt(choice *c, double worth, bool anew)
{
    size_t bytes = c->field.count * sizeof *c->kept;
    double cost = HUGE_VAL;
    if (c->status != OK) return;
    for (size_t i = 0; i < c->field.count; i++)
        c->field.shading[i] = pst_lobe_translate(&c->best, &c->trial, &c->kept[i]);
    c->status = anew ? pst_field_fit(&c->field, &cost) : pst_field_refine(&c->field, &cost);
    if (c->status != OK || !(cost < c->cost * (1 - worth))) return; /* a cost that is NaN is not lower either */
    c->cost = cost;
    c->best = c->trial;
    memcpy(c->kept, c->field.shading, bytes);
}

static void try_kinds(choice *c, int count, bool anew)
{
    for (int k = 0; k < count; k++) {
        c->trial = c->best;
        c->trial.masking = kinds[k].masking;
        c->trial.tail = kinds[k].tail;
        attempt(c, worth_kind, anew);
    }
}

static void try_views(choice *c)
{
    static const float fov[] = {20, 40, 60}; /* fields of view in degrees */
    const merlin_capture *capture = c->field.problem->capture;
    for (size_t k = 0; k < sizeof fov / sizeof *fov; k++) {
        c->trial = c->best;
        c->trial.focal = pinhole_of(capture->width, capture->height, fov[k]).focal;
        attempt(c, worth_view, false);
    }
}

/* Tries a terminator with new fits of lobes of both kinds, as lobes that stand in for a terminator do not give way to
 * it gradually. */
static void try_terminator(choice *c)
{
    for (int k = 0; k < (c->best.tail > 0 ? UNLIKE : 1); k++) {
        c->trial = c->best;
        c->trial.terminator = likely_terminator;
        if (c->best.tail > 0) {
            c->trial.masking = kinds[k].masking;
            c->trial.tail = kinds[k].tail;
        }
        attempt(c, c->best.terminator > 0 ? 0 : worth_terminator, true);
    }
}

/* Moves the terminator in steps while they help. */
static void move_terminator(choice *c, float step)
{
    float from;
    do {
        from = c->best.terminator;
        c->trial = c->best;
        c->trial.terminator = from + step;
        if (c->trial.terminator > 0) attempt(c, 0, false);
    } while (c->best.terminator != from);
}

static void refine_terminator(choice *c)
{
    float step = 0.03f;
    for (int round = 0; round < 5; round++, step /= 2) {
        move_terminator(c, -step);
        move_terminator(c, step);
    }
}

status pst_lobe_admit(const pst_field *sample, pst_lobe *lobe)
{
    /* where many observations are inliers a shadow may cost more, as a rough surface's dark side is not one */
    static const pst_lobe few[] = {{.masking = 1, .width = 0.16f, .shadow = 0.5f},
                                   {.masking = 1, .width = 0.32f, .shadow = 0.5f},
                                   {.masking = 1, .width = 0.08f, .shadow = PST_SHADOW_COST},
                                   {.tail = 2, .masking = 0.28f, .width = 0.08f, .shadow = PST_SHADOW_COST},
                                   {.tail = 2, .masking = 0.28f, .width = 0.16f, .shadow = PST_SHADOW_COST}};
    int count = sample->problem->capture->count;
    *lobe = (pst_lobe){.masking = kinds[0].masking, .tail = kinds[0].tail, .width = 0.04f, .shadow = PST_SHADOW_COST};
    if (count >= PST_MANY_LIGHTS) return OK;
    *lobe = few[0];
    status s = OK;
    double best = HUGE_VAL, cost;
    for (size_t k = 0; s == OK && count >= PREDICTING_LIGHTS && k < sizeof few / sizeof *few; k++) {
        pst_field f = *sample;
        f.lobe = &few[k];
        s = pst_field_predict(&f, &cost);
        if (s != OK || cost >= best * (1 - (few[k].tail > 0 ? worth_freedom : worth_width))) continue;
        best = cost;
        *lobe = few[k];
    }
    return s;
}

static void try_lobes(choice *c)
{
    try_kinds(c, UNLIKE, true);
    if (!c->field.depth) try_views(c);
    if (c->best.focal > 0) try_kinds(c, UNLIKE, true);
}

static void choose(choice *c)
{
    bool glossy = c->best.tail > 0;
    c->trial = c->best;
    if (glossy)
        try_lobes(c);
    else
        attempt(c, 0, true);
    try_terminator(c);
    if (c->best.terminator > 0) refine_terminator(c);
    if (glossy) try_kinds(c, KINDS, false);
}

/* Checks the choice with few lights, where it must also predict better than the admitted lobe: much better with a
 * terminator, which rough surfaces imitate. */
static status confirm(const pst_field *sample, const pst_lobe *chosen, pst_lobe *lobe)
{
    double with = 0, without = 0, share = chosen->terminator > 0 ? 1 - worth_dark : 1;
    pst_field f = *sample;
    status s = OK;
    if (sample->problem->capture->count < PST_MANY_LIGHTS) {
        f.lobe = lobe;
        s = pst_field_predict(&f, &without);
        f.lobe = chosen;
        if (s == OK) s = pst_field_predict(&f, &with);
    }
    if (s == OK && with <= share * without) *lobe = *chosen;
    return s;
}

status pst_lobe_choose(const pst_field *sample, pst_lobe *lobe)
{
    status s = pst_lobe_admit(sample, lobe);
    if (s != OK || sample->problem->capture->count < FEWEST_LIGHTS) return s;
    choice c = {.field = *sample, .best = *lobe, .cost = HUGE_VAL};
    c.field.lobe = &c.trial;
    c.kept = calloc(2 * sample->count, sizeof *c.kept);
    if (!c.kept) return fail(MERLIN_NO_MEMORY, "no memory for a sample of %zu pixels", sample->count);
    c.field.shading = c.kept + sample->count;
    choose(&c);
    free(c.kept);
    return c.status == OK ? confirm(sample, &c.best, lobe) : c.status;
}

/* Returns the cost that the trial saves at pixels where it costs far less. */
static double saved(const pst_shading *with, const pst_shading *without, size_t count)
{
    double sum = 0;
    for (size_t i = 0; i < count; i++)
        if (with[i].cost < pst_far_below(without[i].cost)) sum += (double)(without[i].cost - with[i].cost);
    return sum;
}

/* Finds the second lobe that saves most; first: room for the shading by either lobe. */
static status save_most(const pst_field *sample, const pst_lobe *lobe, pst_shading *first, pst_lobe *second,
                        bool *worth)
{
    double all, cost, most = 0;
    pst_field without = *sample;
    without.lobe = lobe;
    without.shading = first;
    status s = pst_field_fit(&without, &all);
    for (int k = 0; s == OK && k < UNLIKE; k++) {
        pst_lobe trial = *lobe;
        pst_field with = without;
        trial.tail = kinds[k].tail;
        trial.masking = kinds[k].masking;
        with.lobe = &trial;
        with.shading = first + sample->count;
        if (trial.tail == lobe->tail) continue;
        s = pst_field_fit(&with, &cost);
        double gain = s == OK ? saved(with.shading, first, sample->count) : 0;
        if (gain <= fmax(most, worth_second * all)) continue;
        most = gain;
        *second = trial;
        *worth = true;
    }
    return s;
}

status pst_lobe_choose_second(const pst_field *sample, const pst_lobe *lobe, pst_lobe *second, bool *worth)
{
    *worth = false;
    if (sample->problem->capture->count < PST_MANY_LIGHTS || lobe->tail == 0) return OK;
    pst_shading *shading = calloc(2 * sample->count, sizeof *shading);
    if (!shading) return fail(MERLIN_NO_MEMORY, "no memory for a sample of %zu pixels", sample->count);
    status s = save_most(sample, lobe, shading, second, worth);
    free(shading);
    return s;
}
