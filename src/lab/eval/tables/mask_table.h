/* SPDX-License-Identifier: MIT */
/* Compares the results of the search for an object with known masks, of photographs and of composites (composite.h).
 *
 *     mask_table table = {0};
 *     status s = mask_table_add(&table, &photo);
 *     if (s == OK) s = mask_table_add_samples(&table, paths, count, seed, &watch);
 *     if (s == OK) mask_table_print(&table, stdout);
 *     mask_table_free(&table); */
#ifndef MERLIN_LAB_EVAL_TABLES_MASK_TABLE_H
#define MERLIN_LAB_EVAL_TABLES_MASK_TABLE_H

#include <stdbool.h>
#include <stdio.h>

#include "base/progress.h"
#include "lab/eval/metrics/composite.h"
#include "merlin/merlin.h"

/* Intersection over union from which on a mask counts as correct. */
#define MASK_IS_RIGHT 0.97
/* Kinds of pictures: those of composite.h, and photographs. */
enum { MASK_PHOTO = COMPOSITE_KINDS, MASK_KINDS, MASK_BINS = 5 };

typedef struct mask_row {
    char name[64];
    int kind;
    bool found; /* whether the search found something */
    double iou; /* intersection over union of the pixels covered by half or more */
    double confidence;
} mask_row;

typedef struct mask_table {
    mask_row *row;
    size_t count;
} mask_table;

/* A picture to be searched, and the place of its object. */
typedef struct mask_truth {
    const char *name;
    int kind;
    const img *photo, *mask;
    const merlin_hint *hint; /* NULL: none */
} mask_truth;

status mask_table_add(mask_table *t, const mask_truth *truth);
/* Adds composites of every kind for each sample; stopped (may be NULL) is called between some of them. */
status mask_table_add_samples(mask_table *t, char *const *paths, size_t count, uint64_t seed, progress *shown,
                              int (*stopped)(void));
void mask_table_free(mask_table *t);

/* Counts over some of the rows. */
typedef struct mask_counts {
    size_t pictures, right, sure, sure_right; /* right: MASK_IS_RIGHT; sure: confidence of 0.8 or more */
    size_t told;                              /* number with a warning about low confidence */
    double median;                            /* of the intersections over unions */
} mask_counts;
/* Counts the rows of a kind, or of all if that is -1, whose confidence is within [low, high). Only MERLIN_NO_MEMORY is
 * possible. */
status mask_table_count(const mask_table *t, int kind, double low, double high, mask_counts *out);

status mask_table_print(const mask_table *t, FILE *stream);
/* Returns the JSON text, malloc'ed; NULL without memory. */
char *mask_table_json(const mask_table *t);

#endif
