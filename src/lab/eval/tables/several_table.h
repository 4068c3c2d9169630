/* SPDX-License-Identifier: MIT */
/* Measures maps from several photographs of an object, each under a lamp of its own of which nothing is known, by their
 * number, on samples that merlin-lab render made with --lamps. A network of one photograph gives the mean of what it
 * makes of each.
 *
 *     several_options options = {.data = "lit", .weights = "several.safetensors", .views = NETWORK_VIEWS,
 *                                .size = NETWORK_SIZE};
 *     several_table table;
 *     status s = several_table_run(&options, &table);
 *     if (s == OK) several_table_print(&table, stdout); */
#ifndef MERLIN_LAB_EVAL_TABLES_SEVERAL_TABLE_H
#define MERLIN_LAB_EVAL_TABLES_SEVERAL_TABLE_H

#include <stdbool.h>
#include <stdio.h>

#include "lab/eval/tables/lit_subject.h"

/* Rows: 1, 2, 4, 8 and 16 photographs, as far as the samples have so many lamps. */
enum { SEVERAL_ROWS = 5 };

typedef struct several_table {
    char model[64];
    bool together;    /* the network sees all photographs at once */
    bool only_lights; /* it makes no maps: figures of maps are 0 */
    size_t samples;
    size_t count[SEVERAL_ROWS];
    double mean[SEVERAL_ROWS][LIT_FIGURES];
    double lamp[SEVERAL_ROWS]; /* mean error of the lamps' directions from the middle of the object, degrees */
    double seconds;
} several_table;

typedef struct several_options {
    const char *data, *weights;
    const char
        *several; /* weights that compare the photographs, as merlin_model_add_several takes them; NULL: none do */
    size_t count; /* samples at most; 0: all */
    int views;
    int size; /* side of the photographs that the network sees, as in merlin_params; its maps are enlarged */
    bool quiet;
    int (*stopped)(void); /* asked between samples; NULL: never */
} several_options;

/* MERLIN_BAD_INPUT for samples without lamps or environment, and for weights of a flash alone. */
status several_table_run(const several_options *options, several_table *out);
void several_table_print(const several_table *t, FILE *stream);
/* malloc'ed; NULL if memory ran out. */
char *several_table_json(const several_table *t);

#endif
