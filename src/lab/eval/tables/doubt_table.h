/* SPDX-License-Identifier: MIT */
/* Counts how often an estimate's doubts (merlin/maps.h) are right: on pictures lit by a flash at the lens, and on
 * others.
 *
 *     doubt_table table = {0};
 *     status s = doubt_table_add(&table, model, &photo);       photo.kind says what is true of it
 *     if (s == OK) s = doubt_table_add_sample(&table, model, "samples/000000.exr");
 *     if (s == OK) doubt_table_print(&table, stdout);
 *     doubt_table_free(&table);
 */
#ifndef MERLIN_LAB_EVAL_TABLES_DOUBT_TABLE_H
#define MERLIN_LAB_EVAL_TABLES_DOUBT_TABLE_H

#include <stdio.h>

#include "estimate/photo/estimate.h"

typedef enum doubt_kind {
    DOUBT_RIGHT_PHOTO, /* taken by a flash at the lens */
    DOUBT_FLASH,       /* of a sample: under its flash, */
    DOUBT_FLASH_ROOM,  /* with a tenth to a sixth of the light from its environment, */
    DOUBT_ROOM,        /* by its environment alone, */
    DOUBT_LAMP,        /* or by a lamp from 25 to 50 degrees beside the lens, */
    DOUBT_LAMP_FAR,    /* and more */
    DOUBT_WRONG_PHOTO, /* taken by other light, or of no object */
    DOUBT_KINDS
} doubt_kind;

typedef struct doubt_row {
    char name[64];
    doubt_kind kind;
    light_cues cues;
    float elsewhere; /* merlin_maps' light_elsewhere */
    unsigned doubts;
} doubt_row;

typedef struct doubt_table {
    doubt_row *row;
    size_t count;
} doubt_table;

/* Picture to be estimated, which adding it frees. */
typedef struct doubt_photo {
    const char *name;
    doubt_kind kind;
    merlin_image picture;
    merlin_object object;
    merlin_shot shot;
} doubt_photo;

status doubt_table_add(doubt_table *t, merlin_model *model, doubt_photo *photo);
/* Under all lights that the sample was rendered under, but lamps within 25 degrees of the lens. */
status doubt_table_add_sample(doubt_table *t, merlin_model *model, const char *path);
void doubt_table_free(doubt_table *t);

/* Numbers of a kind's pictures, of those whose light is doubted, and of those with any doubt at all. */
typedef struct doubt_counts {
    size_t pictures, light, any;
} doubt_counts;
doubt_counts doubt_table_count(const doubt_table *t, doubt_kind kind);

void doubt_table_print(const doubt_table *t, FILE *stream);
/* malloc'ed; NULL if memory ran out. */
char *doubt_table_json(const doubt_table *t);

#endif
