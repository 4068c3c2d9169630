/* SPDX-License-Identifier: MIT */
/* Table 3 of the paper: how far normals are off that come from a single photograph, from that photograph relit, and
 * from real pictures under as many lights.
 *
 *     stereo_options options = {.data = "near-field", .weights = "models/merlin-point.safetensors"};
 *     stereo_table table;
 *     status s = stereo_table_run(&options, &table);
 *     if (s == OK) stereo_table_print(&table, stdout);
 *     stereo_table_free(&table);
 *
 * What each row means is in docs/notes/one_photograph.md. Equal data, weights and number type of the processor give
 * equal figures. */
#ifndef MERLIN_LAB_EVAL_STEREO_STEREO_TABLE_H
#define MERLIN_LAB_EVAL_STEREO_STEREO_TABLE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

#include "base/status.h"
#include "lab/eval/stereo/stereo_row.h"

struct cJSON;

typedef struct stereo_score {
    double
        error; /* mean angle to the true normals over the object, degrees; the mean of the subsets that were solved */
    double spread; /* standard deviation of their errors; 0 for a single one */
    int failed;    /* subsets that the solver refused; if all, error is NAN, as it is of a row that was not asked for */
} stereo_score;

typedef struct stereo_column {
    char name[32];
    size_t pixels; /* of the object, with a known normal */
    int pictures;  /* real ones to draw from */
    stereo_score row[STEREO_ROWS];
} stereo_column;

typedef struct stereo_table {
    char model[64];
    stereo_column *object;
    size_t count;
    int draws, pictures; /* for each row, and of a draw */
    double seconds;
} stereo_table;

typedef struct stereo_options {
    const char *data, *weights, *flash; /* flash: weights for what is seen as a flash alone, or NULL */
    const char *judge, *several; /* weights of the universal rows: merlin_model_open's and _add_several's (may be NULL);
                                  * judge NULL: without these rows */
    const char *nfps;            /* weights of the rows of nfps, and with which near begins; NULL: without */
    bool relit_only;             /* without the rows of real pictures, which are the same for all weights */
    size_t count;                /* the first so many objects; 0: all */
    int draws;                   /* the first so many of the SUBSETS draws; 0: all */
    int pictures;                /* of a draw; 0: SUBSET_PICTURES */
    const char *figure;          /* PNG of normals and where they are off, a line an object; NULL: none */
    bool quiet;
    int (*stopped)(void); /* asked between solutions; NULL: never */
} stereo_options;

/* MERLIN_BAD_INPUT, with the object's path in the message, for data that stereo_object_read refuses. */
status stereo_table_run(const stereo_options *options, stereo_table *out);
void stereo_table_free(stereo_table *t);

/* Returns the mean over the objects that were solved; NAN if there are none. */
double stereo_table_mean(const stereo_table *t, stereo_row row);

/* Returns the mean over the objects of the draws' standard deviation; NAN if there are none. */
double stereo_table_spread(const stereo_table *t, stereo_row row);

/* Print the names of the objects, and the figures of a row with their mean. */
void stereo_table_print_heading(const stereo_table *t, FILE *stream);
void stereo_table_print_row(const stereo_table *t, stereo_row row, const char *label, FILE *stream);
/* Puts the table's figures into a JSON object. */
void stereo_table_put(const stereo_table *t, struct cJSON *o);

/* Prints the table in the layout of the paper's, and one line each about the gain of relit pictures over the single
 * one. */
void stereo_table_print(const stereo_table *t, FILE *stream);
/* Returns the JSON text, malloc'ed; NULL without memory. */
char *stereo_table_json(const stereo_table *t);

#endif
