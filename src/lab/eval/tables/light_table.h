/* SPDX-License-Identifier: MIT */
/* Measures an estimate by the kind of light in the photograph, on samples that merlin-lab render made with
 * --lamps.
 *
 *     light_options options = {.data = "lit", .weights = "merlin-any.safetensors", .views = NETWORK_VIEWS};
 *     light_table table;
 *     status s = light_table_run(&options, &table);
 *     if (s == OK) light_table_print(&table, stdout);
 *
 * Of each sample a photograph is mixed for every kind, exposed as a camera does, and estimated as merlin estimate does
 * it with the sample's lens known. Lamps are told apart by their angle from the line to the camera. */
#ifndef MERLIN_LAB_EVAL_TABLES_LIGHT_TABLE_H
#define MERLIN_LAB_EVAL_TABLES_LIGHT_TABLE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

#include "base/status.h"
#include "lab/eval/tables/lit_subject.h"

enum { LIGHT_LAMPS = 5 };
typedef enum light_kind {
    LIGHT_FLASH,
    LIGHT_FLASH_IN_ROOM, /* the room gives half as much light */
    LIGHT_ROOM,
    LIGHT_LAMP,                                    /* alone, at one of so many angles, and on: */
    LIGHT_LAMP_IN_ROOM = LIGHT_LAMP + LIGHT_LAMPS, /* the sample's first lamp, the room half as much */
    LIGHT_KINDS
} light_kind;

/* Degrees where the classes of lamps end; the last is open. */
extern const float light_angles[LIGHT_LAMPS - 1];

typedef enum light_figure {
    LIGHT_ANGLE = LIT_ANGLE,
    LIGHT_ALBEDO = LIT_ALBEDO,
    LIGHT_ALBEDO_FREE = LIT_ALBEDO_FREE,
    LIGHT_ROUGHNESS = LIT_ROUGHNESS,
    LIGHT_RELIEF = LIT_RELIEF,
    LIGHT_REBUILT,   /* structural similarity of the photograph and what the maps' reconstruction makes of it */
    LIGHT_AS_FLASH,  /* share of the photographs that are seen as lit by a flash alone; models of any light alone */
    LIGHT_DIRECTION, /* of the strongest lamp where one is found, degrees; the same */
    LIGHT_FIGURES
} light_figure;

typedef struct light_table {
    char model[64], flash_model[64]; /* flash_model: empty for none */
    size_t samples;
    size_t count[LIGHT_KINDS];
    double mean[LIGHT_KINDS][LIGHT_FIGURES]; /* of LIGHT_DIRECTION the median */
    bool directions;                         /* the model tells any */
    double seconds;
} light_table;

typedef struct light_options {
    const char *data, *weights, *flash; /* flash: weights for what is seen as a flash alone, or NULL */
    size_t count;                       /* samples at most; 0: all */
    int views;
    bool lens_unknown; /* the model is told nothing of the lens */
    bool quiet;
    int (*stopped)(void); /* asked between samples; NULL: never */
} light_options;

/* MERLIN_BAD_INPUT for samples without lamps or environment. */
status light_table_run(const light_options *options, light_table *out);

const char *light_kind_name(light_kind kind);
void light_table_print(const light_table *t, FILE *stream);
/* malloc'ed; NULL if memory ran out. */
char *light_table_json(const light_table *t);

#endif
