#include "stereo/lobe_choice.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A choice that explains less than this share of the loss is taken for a chance of the sample. */
static const double worth_kind = 0.02, worth_view = 0.05, worth_terminator = 0.1;

/* With fewer lights τ and the lobe would be read from the shadows. */
enum { FEWEST_LIGHTS = 12 };

typedef struct kind {
    float masking;
    int tail;
} kind;

/* The first is the plain choice; those that are not like another start from nothing. */
static const kind kinds[] = {{0.28f, 2}, {1, 8}, {1, 2}, {1, 4}, {0.28f, 8}};
enum { UNLIKE = 2, KINDS = sizeof kinds / sizeof *kinds };

typedef struct choice {
    pst_field field; /* lobe: what is tried */
    pst_lobe best, trial;
    pst_shading *kept; /* of the best */
    double cost;
    status status;
} choice;

/* Keeps the trial if it saves more than a share of the cost. anew: from the observations alone. */
static void attempt(choice *c, double worth, bool anew)
{
    size_t bytes = c->field.count * sizeof *c->kept;
    double cost = HUGE_VAL;
    if (c->status != OK) return;
    memcpy(c->field.shading, c->kept, bytes);
    c->status = anew ? pst_field_fit(&c->field, &cost) : pst_field_refine(&c->field, &cost);
    if (c->status != OK || cost >= c->cost * (1 - worth)) return;
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
    static const float fov[] = {20, 40, 60}; /* degrees across */
    float width = (float)c->field.problem->capture->width;
    for (size_t k = 0; k < sizeof fov / sizeof *fov; k++) {
        c->trial = c->best;
        c->trial.focal = 0.5f * width / tanf(fov[k] * 0.00872664626f);
        attempt(c, worth_view, false);
    }
}

static void try_terminators(choice *c)
{
    for (int k = 1; k <= 4; k++) {
        c->trial = c->best;
        c->trial.terminator = 0.05f * (float)k;
        attempt(c, c->best.terminator > 0 ? 0 : worth_terminator, false);
        if (c->best.terminator != c->trial.terminator) return;
    }
}

static void refine_terminator(choice *c)
{
    float step = 0.02f;
    for (int round = 0; round < 5; round++, step /= 2) {
        float around = c->best.terminator;
        for (int side = -1; side <= 1; side += 2) {
            c->trial = c->best;
            c->trial.terminator = around + step * (float)side;
            attempt(c, 0, false);
        }
    }
}

status pst_lobe_choose(const pst_field *sample, pst_lobe *lobe)
{
    *lobe = (pst_lobe){.masking = kinds[0].masking, .tail = kinds[0].tail};
    if (sample->problem->capture->count < FEWEST_LIGHTS) return OK;
    choice c = {.field = *sample, .best = *lobe, .cost = HUGE_VAL};
    c.field.lobe = &c.trial;
    c.kept = calloc(2 * sample->count, sizeof *c.kept);
    if (!c.kept) return fail(ERROR_MEMORY, "no memory for a sample of %zu pixels", sample->count);
    c.field.shading = c.kept + sample->count;
    try_kinds(&c, UNLIKE, true);
    if (!sample->depth) try_views(&c);
    if (c.best.focal > 0) try_kinds(&c, UNLIKE, true);
    try_terminators(&c);
    if (c.best.terminator > 0) {
        /* lobes that have stood in for it are given up */
        try_kinds(&c, UNLIKE, true);
        refine_terminator(&c);
    }
    try_kinds(&c, KINDS, false);
    free(c.kept);
    *lobe = c.best;
    return c.status;
}
