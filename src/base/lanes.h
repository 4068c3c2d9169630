/* SPDX-License-Identifier: MIT */
/* Sixteen vectors side by side: loops over lanes compile to vector instructions as wide as the processor has.
 *
 *     lanes p;
 *     lanes_put(&p, i, point);
 *     #pragma omp simd
 *     for (int k = 0; k < LANES; k++) length[k] = vec3_length(lanes_at(&p, k));
 *
 * Loops compute all lanes, used or not: one that stops early would need a scalar remainder. */
#ifndef MERLIN_BASE_LANES_H
#define MERLIN_BASE_LANES_H

#include <stdbool.h>
#include <stdint.h>

#include "base/inline.h"
#include "base/vec.h"

enum { LANES = 16 };

/* Sixteen vectors, one a lane, by component. */
typedef struct lanes {
    float x[LANES], y[LANES], z[LANES];
} lanes;

/* A set of lanes: bit i for lane i. */
typedef uint32_t lane_set;

static inline bool lane_in(lane_set set, int i)
{
    return (set >> i) & 1;
}

static inline lane_set lanes_first(int count)
{
    return (UINT32_C(1) << count) - 1;
}

static inline vec3 lanes_at(const lanes *l, int i)
{
    return vec3_make(l->x[i], l->y[i], l->z[i]);
}

static inline void lanes_put(lanes *l, int i, vec3 v)
{
    l->x[i] = v.x;
    l->y[i] = v.y;
    l->z[i] = v.z;
}

#endif
