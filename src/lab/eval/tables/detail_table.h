/* SPDX-License-Identifier: MIT */
/* What a larger picture adds to an estimate's shape (estimate/photo/detail.h), on samples of more than NETWORK_SIZE
 * pixels.
 *
 *     detail_options options = {.data = "large", .weights = "merlin-point.safetensors", .views = NETWORK_VIEWS};
 *     detail_table table;
 *     status s = detail_table_run(&options, &table);
 *     if (s == OK) detail_table_print(&table, stdout);
 *
 * Three estimates of each sample's flash picture, all brought to its size as merlin estimate does it: of the picture of
 * NETWORK_SIZE alone, of the larger picture alone, and of both. */
#ifndef MERLIN_LAB_EVAL_TABLES_DETAIL_TABLE_H
#define MERLIN_LAB_EVAL_TABLES_DETAIL_TABLE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

#include "base/status.h"

typedef enum detail_way { DETAIL_SMALL, DETAIL_LARGE, DETAIL_BOTH, DETAIL_WAYS } detail_way;

typedef enum detail_figure {
    DETAIL_ALBEDO, /* mean squared errors as in eval/metrics.h */
    DETAIL_NORMAL,
    DETAIL_ANGLE, /* degrees */
    DETAIL_DEPTH,
    DETAIL_ROUGHNESS,
    DETAIL_RELIT, /* SSIM by the maps' BRDF under four lights, without shadows and bounces */
    DETAIL_FIGURES
} detail_figure;

typedef struct detail_table {
    char model[64];
    size_t samples;
    int size, larger; /* of the samples; of the larger picture */
    int views;        /* of the picture of NETWORK_SIZE */
    double mean[DETAIL_WAYS][DETAIL_FIGURES];
    double seconds;
} detail_table;

typedef struct detail_options {
    const char *data, *weights;
    size_t count; /* samples at most; 0: all */
    int views;
    bool quiet;
    int (*stopped)(void); /* asked between samples; NULL: never */
} detail_options;

/* MERLIN_BAD_INPUT for samples of one size with NETWORK_SIZE, or smaller. */
status detail_table_run(const detail_options *options, detail_table *out);

void detail_table_print(const detail_table *t, FILE *stream);
/* malloc'ed; NULL if memory ran out. */
char *detail_table_json(const detail_table *t);

#endif
