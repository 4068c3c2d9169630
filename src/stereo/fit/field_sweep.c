/* SPDX-License-Identifier: MIT */
/* Sweeps over a field in which each pixel looks at its neighbours' results of the sweep before. */
#include <stdlib.h>
#include <string.h>

#include "stereo/fit/field_fit.h"
#include "stereo/fit/field_job.h"

/* New results of a band of pixels, which replace the old ones once nobody looks at these any more. */
typedef struct held_band {
    pst_shading *next;
    size_t first, end;
} held_band;

/* Returns how many pixels cost less than before. news: of each pixel, whether it does; may be NULL. */
static size_t take(const pst_field *f, const held_band *held, bool *news)
{
    size_t moved = 0;
    for (size_t i = held->first; i < held->end; i++) {
        const pst_shading *next = &held->next[i - held->first];
        const bool better = next->cost < f->shading[i].cost;
        moved += better;
        if (news) news[i] = better;
        f->shading[i] = *next;
    }
    return moved;
}

/* Runs a task for all pixels, band by band: as a band is wider than a row, its pixels look at those of the bands beside
 * it only, and the results of the band before the last are not needed any more. */
static status sweep(pst_field_job *job, held_band held[2], bool *news, size_t *moved)
{
    const pst_field *f = job->field;
    const size_t band = pst_field_band(f);
    status s = OK;
    held[0].first = held[0].end = held[1].first = held[1].end = 0;
    *moved = 0;
    for (size_t first = 0; first < f->count && s == OK; first += band) {
        held_band *now = &held[first / band % 2], *before = &held[1 - first / band % 2];
        now->first = first;
        now->end = first + band < f->count ? first + band : f->count;
        memcpy(now->next, f->shading + first, (now->end - first) * sizeof *now->next);
        job->next = now->next;
        s = pst_field_run(job, first, now->end);
        if (s == OK) *moved += take(f, before, news);
        before->end = before->first;
    }
    for (int k = 0; k < 2 && s == OK; k++)
        *moved += take(f, &held[k], news);
    return s;
}

static status held_new(const pst_field *f, held_band held[2])
{
    const size_t band = pst_field_band(f), most = band < f->count ? band : f->count;
    held[0].next = calloc(2 * most + 1, sizeof *held[0].next);
    if (!held[0].next) return fail(MERLIN_NO_MEMORY, "no memory to fit %zu pixels", f->count);
    held[1].next = held[0].next + most;
    return OK;
}

static void held_free(held_band held[2])
{
    free(held[0].next);
}

int32_t *pst_field_slots(const pst_field *f)
{
    const merlin_capture *c = f->problem->capture;
    size_t size = (size_t)c->width * (size_t)c->height;
    int32_t *slot = malloc(size * sizeof *slot);
    if (!slot) return NULL;
    memset(slot, 0xff, size * sizeof *slot);
    for (size_t i = 0; i < f->count; i++)
        slot[f->pixel[i]] = (int32_t)i;
    return slot;
}

status pst_field_spread(const pst_field *f, int sweeps)
{
    size_t moved = 1;
    held_band held[2];
    int32_t *slot = pst_field_slots(f);
    bool *news = malloc(f->count * sizeof *news);
    status s = held_new(f, held);
    if (s == OK && (!slot || !news)) s = fail(MERLIN_NO_MEMORY, "no memory to fit %zu pixels", f->count);
    for (int k = 0; s == OK && k < sweeps && moved > 0; k++) {
        pst_field_job job = {.field = f, .task = PST_SPREAD, .around = {f, slot, k > 0 ? news : NULL}};
        s = sweep(&job, held, news, &moved);
    }
    held_free(held);
    free(slot);
    free(news);
    return s;
}

static float mean_cost(const pst_field *f)
{
    double cost = 0;
    for (size_t i = 0; i < f->count; i++)
        cost += (double)f->shading[i].cost;
    return (float)(cost / (double)f->count);
}

status pst_field_replace_outliers(const pst_field *f, int sweeps)
{
    size_t moved;
    held_band held[2];
    int32_t *slot = pst_field_slots(f);
    status s = held_new(f, held);
    if (s == OK && !slot) s = fail(MERLIN_NO_MEMORY, "no memory to fit %zu pixels", f->count);
    for (int k = 0; s == OK && k < sweeps; k++) {
        pst_field_job job = {.field = f,
                             .task = PST_OUTLIERS,
                             .around = {.field = f, .slot = slot},
                             .contradiction = PST_FAR_LESS + mean_cost(f)};
        s = sweep(&job, held, NULL, &moved);
    }
    held_free(held);
    free(slot);
    return s;
}
