/* SPDX-License-Identifier: MIT */
/* Rows of the stereo table. */
#ifndef MERLIN_LAB_EVAL_STEREO_STEREO_ROW_H
#define MERLIN_LAB_EVAL_STEREO_STEREO_ROW_H

#include <stdbool.h>

typedef enum stereo_row {
    STEREO_SINGLE, /* the network's own normals */
    STEREO_RELIT,  /* photometric stereo from relit pictures, lights known */
    STEREO_REAL,   /* from real ones */
    STEREO_RELIT_UNCALIBRATED,
    STEREO_REAL_UNCALIBRATED,
    STEREO_RELIT_UNIVERSAL, /* from relit pictures seen together by a network, lights unknown (merlin_maps_from_capture)
                             */
    STEREO_REAL_UNIVERSAL,
    STEREO_RELIT_NFPS, /* by the network of near lights, lights known (nfps/nfps_stereo.h) */
    STEREO_REAL_NFPS,
    STEREO_RELIT_NFPS_UNCALIBRATED, /* by the same with lights that a network tells (lights_of_capture) */
    STEREO_REAL_NFPS_UNCALIBRATED,
    STEREO_ROWS
} stereo_row;

/* Tells whether a row is of real pictures. */
static inline bool stereo_row_is_real(stereo_row row)
{
    return row == STEREO_REAL || row == STEREO_REAL_UNCALIBRATED || row == STEREO_REAL_UNIVERSAL ||
           row == STEREO_REAL_NFPS || row == STEREO_REAL_NFPS_UNCALIBRATED;
}

static inline bool stereo_row_is_universal(stereo_row row)
{
    return row == STEREO_RELIT_UNIVERSAL || row == STEREO_REAL_UNIVERSAL;
}

static inline bool stereo_row_is_nfps(stereo_row row)
{
    return row >= STEREO_RELIT_NFPS;
}

/* Tells whether a row wants the network that compares pictures. */
static inline bool stereo_row_is_compared(stereo_row row)
{
    return stereo_row_is_universal(row) || row >= STEREO_RELIT_NFPS_UNCALIBRATED;
}

#endif
