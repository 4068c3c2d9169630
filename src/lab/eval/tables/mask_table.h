/* SPDX-License-Identifier: MIT */
/* Holds what the search for an object finds against masks that are known: photographs' and composites' (composite.h).
 *
 *     mask_table table = {0};
 *     status s = mask_table_add(&table, &photo);
 *     if (s == OK) s = mask_table_add_samples(&table, paths, count, seed, &watch);
 *     if (s == OK) mask_table_print(&table, stdout);
 *     mask_table_free(&table);
 */
#ifndef MERLIN_LAB_EVAL_TABLES_MASK_TABLE_H
#define MERLIN_LAB_EVAL_TABLES_MASK_TABLE_H

#include <stdbool.h>
#include <stdio.h>

#include "base/progress.h"
#include "lab/eval/metrics/composite.h"
#include "merlin/merlin.h"

/* Intersection over union from which a mask counts as right. */
#define MASK_IS_RIGHT 0.97
/* Kinds of pictures: those of composite.h, and photographs. */
enum { MASK_PHOTO = COMPOSITE_KINDS, MASK_KINDS, MASK_BINS = 5 };

typedef struct mask_row {
    char name[64];
    int kind;
    bool found; /* the search found something at all */
    double iou; /* intersection over union of what is covered by half or more */
    double confidence;
} mask_row;

typedef struct mask_table {
    mask_row *row;
    size_t count;
} mask_table;

/* Picture to be searched, and where its object is. */
typedef struct mask_truth {
    const char *name;
    int kind;
    const img *photo, *mask;
    const merlin_hint *hint; /* NULL: none */
} mask_truth;

status mask_table_add(mask_table *t, const mask_truth *truth);
/* Composites of every kind of each sample; stopped (may be NULL) is asked between some of them. */
status mask_table_add_samples(mask_table *t, char *const *paths, size_t count, uint64_t seed, progress *shown,
                              int (*stopped)(void));
void mask_table_free(mask_table *t);

/* What is known of some of the rows. */
typedef struct mask_counts {
    size_t pictures, right, sure, sure_right; /* right: MASK_IS_RIGHT; sure: confidence of 0.8 or more */
    size_t told;                              /* with so little confidence that a warning says so */
    double median;                            /* of the intersections over unions */
} mask_counts;
/* Of a kind, or of all if that is -1, whose confidence is within [low, high). MERLIN_NO_MEMORY alone. */
status mask_table_count(const mask_table *t, int kind, double low, double high, mask_counts *out);

status mask_table_print(const mask_table *t, FILE *stream);
/* malloc'ed; NULL if memory ran out. */
char *mask_table_json(const mask_table *t);

#endif
