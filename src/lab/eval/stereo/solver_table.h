/* SPDX-License-Identifier: MIT */
/* Accuracy and speed of the solvers of photometric stereo on captures of this project's own objects.
 *
 *     solver_options options = {.seed = 2000, .count = 8, .size = 224};
 *     solver_table table;
 *     status s = solver_table_run(&options, &table);
 *     if (s == OK) solver_table_print(&table, stdout);
 *     solver_table_free(&table);
 *
 * Each object is rendered four times: under 50 distant lights, Lambertian without cast shadows, and glossy with them;
 * and under 50 LEDs at one to two of its sizes with cast shadows, matte and glossy. docs/notes/solvers.md describes the
 * columns. */
#ifndef MERLIN_LAB_EVAL_STEREO_SOLVER_TABLE_H
#define MERLIN_LAB_EVAL_STEREO_SOLVER_TABLE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include "base/status.h"

enum { SOLVER_LIGHTS = 50 };

typedef enum solver_figure {
    SOLVER_LAMBERT_LS, /* mean angle to the true normals, degrees */
    SOLVER_GLOSSY_LS,  /* as all others, unless stated otherwise */
    SOLVER_GLOSSY_ROBUST,
    SOLVER_ROBUST_TIME, /* seconds for 20,000 pixels */
    SOLVER_NEAR_MATTE,
    SOLVER_NEAR_MATTE_DEPTH, /* mean relative error of the depth after aligning its scale */
    SOLVER_NEAR_GLOSSY,
    SOLVER_NEAR_GLOSSY_DEPTH,
    SOLVER_FIGURES
} solver_figure;

typedef struct solver_row {
    char name[32];
    size_t pixels; /* of the object under distant lights */
    float roughness;
    double figure[SOLVER_FIGURES];
} solver_row;

typedef struct solver_table {
    solver_row *object;
    size_t count;
    double seconds;
} solver_table;

typedef struct solver_options {
    uint64_t seed;
    size_t count; /* objects 0 to count - 1 of the seed */
    int size;     /* pixels a side */
    bool quiet;
    int (*stopped)(void); /* asked between captures; NULL: never */
} solver_options;

status solver_table_run(const solver_options *options, solver_table *out);
void solver_table_free(solver_table *t);

double solver_table_mean(const solver_table *t, solver_figure figure);

void solver_table_print(const solver_table *t, FILE *stream);
/* Returns the JSON text, malloc'ed; NULL without memory. */
char *solver_table_json(const solver_table *t);

#endif
