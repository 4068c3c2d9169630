/* SPDX-License-Identifier: MIT */
#include "lab/eval/tables/mask_table.h"

#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/parallel.h"
#include "estimate/object/mask.h"
#include "lab/eval/metrics/metrics.h"

static const double SURE = 0.8;

static double overlap(const img *one, const img *other)
{
    size_t both = 0, either = 0;
    for (size_t i = 0; i < img_value_count(one); i++) {
        bool a = one->data[i] >= 0.5f, b = other->data[i] >= 0.5f;
        both += a && b;
        either += a || b;
    }
    return either ? (double)both / (double)either : 1;
}

/* Nothing found is an answer, too: the search says so itself. */
static status search(const mask_truth *truth, mask_row *row)
{
    img mask = {0};
    mask_choice choice;
    *row = (mask_row){.kind = truth->kind};
    snprintf(row->name, sizeof row->name, "%s", truth->name);
    status s = mask_choose(truth->photo, NULL, truth->hint, &mask, &choice);
    row->found = s == OK;
    if (row->found) row->iou = overlap(&mask, truth->mask);
    if (row->found) row->confidence = (double)choice.confidence;
    img_free(&mask);
    return s == MERLIN_BAD_INPUT ? OK : s;
}

static mask_row *add_rows(mask_table *t, size_t count)
{
    mask_row *larger = realloc(t->row, (t->count + count) * sizeof *larger);
    if (!larger) return NULL;
    t->row = larger;
    t->count += count;
    memset(larger + t->count - count, 0, count * sizeof *larger);
    return larger + t->count - count;
}

status mask_table_add(mask_table *t, const mask_truth *truth)
{
    const img *photo = truth->photo, *mask = truth->mask;
    if (photo->width != mask->width || photo->height != mask->height)
        return fail(MERLIN_BAD_INPUT, "the mask of %s is %d×%d pixels, the photograph %d×%d; they must be equal",
                    truth->name, mask->width, mask->height, photo->width, photo->height);
    mask_row *row = add_rows(t, 1);
    return row ? search(truth, row) : fail(MERLIN_NO_MEMORY, "no memory for a table");
}

void mask_table_free(mask_table *t)
{
    free(t->row);
    *t = (mask_table){0};
}

/* ---- composites ---- */

/* Samples that are worked on at once, and the rows that await their composites. */
typedef struct batch {
    char *const *paths;
    uint64_t seed;
    mask_row *row;
} batch;

static status search_composites(void *context, size_t i)
{
    const batch *b = context;
    sample s;
    status st = sample_read_training(b->paths[i], &s);
    if (st != OK) return st;
    for (int kind = 0; kind < COMPOSITE_KINDS && st == OK; kind++) {
        composite c;
        st = composite_make(&s, b->seed, (composite_kind)kind, &c);
        if (st != OK) break;
        mask_truth truth = {file_name_of(b->paths[i]), kind, &c.photo, &c.mask, NULL};
        st = search(&truth, &b->row[i * COMPOSITE_KINDS + (size_t)kind]);
        composite_free(&c);
    }
    sample_free(&s);
    return st;
}

status mask_table_add_samples(mask_table *t, char *const *paths, size_t count, uint64_t seed, progress *shown,
                              int (*stopped)(void))
{
    const size_t at_once = 4 * (size_t)parallel_threads();
    status s = OK;
    for (size_t i = 0; i < count && s == OK; i += at_once) {
        size_t some = count - i < at_once ? count - i : at_once;
        batch b = {paths + i, seed, add_rows(t, some * COMPOSITE_KINDS)};
        if (!b.row) return fail(MERLIN_NO_MEMORY, "no memory for a table");
        s = parallel_try(some, search_composites, &b);
        if (s == OK) progress_update(shown, t->count, NULL);
        if (s == OK && stopped && stopped()) s = fail(MERLIN_STOPPED, "interrupted");
    }
    return s;
}

/* ---- counts ---- */

status mask_table_count(const mask_table *t, int kind, double low, double high, mask_counts *out)
{
    mask_counts c = {0};
    double *ious = malloc((t->count ? t->count : 1) * sizeof *ious);
    if (!ious) return fail(MERLIN_NO_MEMORY, "no memory for a table");
    for (size_t i = 0; i < t->count; i++) {
        const mask_row *row = &t->row[i];
        if ((kind >= 0 && row->kind != kind) || row->confidence < low || row->confidence >= high) continue;
        ious[c.pictures++] = row->iou;
        bool right = row->iou >= MASK_IS_RIGHT, sure = row->confidence >= SURE;
        c.right += right;
        c.sure += sure;
        c.sure_right += sure && right;
        c.told += row->confidence < MASK_LITTLE_CONFIDENCE;
    }
    if (c.pictures) c.median = eval_median(ious, c.pictures);
    free(ious);
    *out = c;
    return OK;
}
