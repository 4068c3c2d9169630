/* SPDX-License-Identifier: MIT */
/* The input of a solver: a capture with all options resolved, and helper functions. */
#ifndef MERLIN_STEREO_FIT_PROBLEM_H
#define MERLIN_STEREO_FIT_PROBLEM_H

#include <pthread.h>
#include <stdatomic.h>

#include "stereo/capture/capture.h"

/* Counts the fits that a solver has made, over all threads. */
typedef struct pst_effort {
    const watch *watch;
    pthread_t owner; /* the thread that started */
    atomic_size_t done;
    size_t expected;
} pst_effort;

/* Adds fits, from any thread; only the owner reports progress. */
void pst_effort_add(pst_effort *e, size_t fits);

/* Least number of pictures under unknown lights. */
enum { PST_FEWEST_UNKNOWN = 7 };

/* Surface and lights as they are known from elsewhere, such as a network's estimates. */
typedef struct pst_expected {
    const img *normal; /* 3 channels, unit, or zero where there is none, of the pictures' size */
    const img *depth;  /* 1 channel, any unit, 0 where there is none; NULL: unknown */
    /* one per picture: the direction to its light times the probability that there is one; NULL: the lights are known
     */
    const vec3 *light;
    /* the same lights as they are told by who compared the pictures, which is more exact, and their inverse distances
     * from the middle of the object, 1: as far as the camera; NULL: nobody did */
    const vec3 *compared;
    const float *near;
    float doubt_lights; /* share of what is held against near lights that differ from `compared`; 0: all of it */
    bool near_alone;    /* whether the lights are known to be near: distant ones are not tried */
    /* whether of 7 pictures or more under near lights before a known lens only these are wanted, and a coarse depth:
     * normals and albedo stay zero for who solves with them */
    bool lights_alone;
    bool normals_alone; /* whether the depth that near lights give may stay coarse */
} pst_expected;

typedef struct pst_problem {
    const merlin_capture *capture; /* capture with at most PST_MAX_LIGHTS pictures, except for ls */
    const merlin_light *light; /* count; intensities above 0. The capture's own unless a solver has found better ones */
    uint32_t *pixel;           /* indices of the mask's pixels, rows from the top; NULL for ls, which processes all */
    size_t pixel_count;
    float saturation;             /* share of full scale below which values are usable */
    int iterations;               /* 0: the solver's default */
    const pst_expected *expected; /* for unknown and near lights; NULL: nothing */
    pst_effort *effort;           /* may be NULL */
} pst_problem;

/* Checks directions, which must be unit: fewer than 3 lights, or all in a plane through the origin, are refused. */
status pst_check_directions(const merlin_light *light, int count);
/* Refuses lights that are all on one line. */
status pst_check_positions(const merlin_light *light, int count);

/* Sets pixel (malloc'ed, NULL on failure) and pixel_count from a mask of the pictures' size. */
status pst_list_pixels(const merlin_capture *c, pst_problem *p);

/* The bounding rectangle of the pixels, inclusive; it contains at least one. */
typedef struct pst_bounds {
    int left, right, top, bottom;
} pst_bounds;
pst_bounds pst_bounds_of(const pst_problem *p);

#endif
