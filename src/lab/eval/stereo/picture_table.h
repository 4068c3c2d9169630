/* SPDX-License-Identifier: MIT */
/* Errors of an estimate from one picture, for every picture of real captures: each is lit by a lamp from elsewhere.
 *
 *     picture_options options = {.folder = folders, .count = 2, .weights = "merlin-any.safetensors"};
 *     picture_table table;
 *     status s = picture_table_run(&options, &table);
 *     if (s == OK) picture_table_print(&table, stdout);
 *     picture_table_free(&table);
 *
 * Normals are held against the capture's true ones or, where it has none, against those of photometric stereo from all
 * pictures; the estimate is told the mask and nothing of light and lens. */
#ifndef MERLIN_LAB_EVAL_STEREO_PICTURE_TABLE_H
#define MERLIN_LAB_EVAL_STEREO_PICTURE_TABLE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

#include "base/status.h"

typedef struct picture_score {
    char name[64]; /* the file's */
    double aside;  /* degrees from the line to the camera to the light; NAN: a near light's */
    double error;  /* mean angle of normals, degrees */
    double light;  /* degrees by which the lamp that was found is off; NAN where none was */
    bool as_flash; /* another model saw it, for flashes alone */
} picture_score;

typedef struct picture_column {
    char name[64];
    bool true_normals;
    picture_score *picture;
    int count, frontal; /* frontal: the picture whose light is nearest to a flash */
} picture_column;

typedef struct picture_table {
    char model[64];
    picture_column *object;
    size_t count;
    double seconds;
} picture_table;

typedef struct picture_options {
    const char *const *folder; /* captures, as merlin stereo reads them */
    size_t count;
    const char *lights;          /* list of all captures' lights, or NULL: found in the folders */
    const char *weights, *flash; /* flash: weights for what is seen as a flash alone, or NULL */
    bool linear;                 /* 8-bit pictures are, as of merlin_capture_files */
    bool quiet;
    int (*stopped)(void); /* asked between pictures; NULL: never */
} picture_options;

status picture_table_run(const picture_options *options, picture_table *out);
void picture_table_free(picture_table *t);

/* Prints an object a line: its frontal picture, the mean over all, the worst, and the median of its lights. */
void picture_table_print(const picture_table *t, FILE *stream);
/* Every picture; malloc'ed, NULL if memory ran out. */
char *picture_table_json(const picture_table *t);

#endif
