/* SPDX-License-Identifier: MIT */
/* Measures normals from pictures whose lights nobody knows, by their number: those of a network, these refined by
 * photometric stereo (merlin_maps_from_capture), and those of photometric stereo without a network.
 *
 *     unknown_options options = {.data = "near-field", .weights = "merlin-any.safetensors"};
 *     unknown_table table;
 *     status s = unknown_table_run(&options, &table);
 *     if (s == OK) unknown_table_print(&table, stdout);
 *     unknown_table_free(&table); */
#ifndef MERLIN_LAB_EVAL_STEREO_UNKNOWN_TABLE_H
#define MERLIN_LAB_EVAL_STEREO_UNKNOWN_TABLE_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#include "base/status.h"
#include "merlin/stereo.h"

typedef enum unknown_way { UNKNOWN_NETWORK, UNKNOWN_REFINED, UNKNOWN_UNCALIBRATED, UNKNOWN_WAYS } unknown_way;

/* Rows: 1, 2, 4, 8, 16 and 32 pictures, and all, as far as the objects have so many. */
enum { UNKNOWN_ROWS = 7 };
enum { UNKNOWN_LIGHTS = 32, UNKNOWN_RENDERED = 8 };

typedef struct unknown_object {
    char name[32];
    int pictures;
    double error[UNKNOWN_ROWS][UNKNOWN_WAYS];  /* degrees; NAN: not measured, or refused */
    double albedo[UNKNOWN_ROWS][UNKNOWN_WAYS]; /* mean squared, as eval_mse_scale_free times EVAL_UNIT; NAN: unknown */
    double surest[UNKNOWN_ROWS]
                 [UNKNOWN_WAYS]; /* error of the half of the pixels whose spread is least; NAN: no spread */
} unknown_object;

typedef struct unknown_table {
    char model[64];
    size_t count;
    unknown_object *object;
    double seconds;
} unknown_table;

typedef struct unknown_options {
    const char *data, *weights;      /* data NULL: objects are rendered under UNKNOWN_LIGHTS distant lights */
    const char *several;             /* weights that see the pictures together; NULL: `weights` see them one by one */
    const merlin_near_network *near; /* NULL: without */
    uint64_t seed;                   /* of rendered objects */
    size_t count;                    /* objects at most; 0: all, or UNKNOWN_RENDERED */
    int views;
    float dim;         /* least share to which pictures are exposed by chance; 0 or 1: all alike */
    bool lens_unknown; /* nothing is told of the camera, whatever the objects' is */
    bool quiet;
    int (*stopped)(void); /* asked between solutions; NULL: never */
} unknown_options;

/* Objects are those of stereo_object.h. */
status unknown_table_run(const unknown_options *options, unknown_table *out);
void unknown_table_free(unknown_table *t);
/* Returns the number of pictures of a row of an object; 0: it has fewer. */
int unknown_row_pictures(const unknown_object *o, int row);
void unknown_table_print(const unknown_table *t, FILE *stream);
/* malloc'ed; NULL if memory ran out. */
char *unknown_table_json(const unknown_table *t);

#endif
