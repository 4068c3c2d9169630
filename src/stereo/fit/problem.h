/* SPDX-License-Identifier: MIT */
/* The problem that a solver is given: a capture with every choice of the options made, and what all of them ask of it.
 */
#ifndef MERLIN_STEREO_FIT_PROBLEM_H
#define MERLIN_STEREO_FIT_PROBLEM_H

#include <pthread.h>
#include <stdatomic.h>

#include "stereo/capture/capture.h"

/* Counts the fits that a solver has done, by all threads. */
typedef struct pst_effort {
    const watch *watch;
    pthread_t owner; /* the thread that began */
    atomic_size_t done;
    size_t expected;
} pst_effort;

/* Called by any thread; the owner tells. */
void pst_effort_add(pst_effort *e, size_t fits);

typedef struct pst_problem {
    const merlin_capture *capture; /* of at most PST_MAX_LIGHTS pictures, but for ls */
    const merlin_light *light;     /* count; intensities above 0. The capture's own unless a solver found better */
    uint32_t *pixel; /* indices of the mask's pixels, rows from the top; NULL for ls, which streams them all */
    size_t pixel_count;
    float saturation;   /* a share of full scale: what is below it is usable */
    int iterations;     /* 0: the solver's own */
    pst_effort *effort; /* may be NULL */
} pst_problem;

/* Directions are unit already. Fewer than 3 lights, or all in a plane through the origin, are refused. */
status pst_check_directions(const merlin_light *light, int count);
/* Refuses lights that are all on one line. */
status pst_check_positions(const merlin_light *light, int count);

/* Sets pixel (malloc'ed, NULL on failure) and pixel_count, from a mask of the pictures' size. */
status pst_list_pixels(const merlin_capture *c, pst_problem *p);

/* The rectangle that the pixels fill, all four inside it; of one pixel at least. */
typedef struct pst_bounds {
    int left, right, top, bottom;
} pst_bounds;
pst_bounds pst_bounds_of(const pst_problem *p);

#endif
