/* SPDX-License-Identifier: MIT */
/* Values of maps at sampled points. */
#ifndef MERLIN_NN_CPU_KERNELS_GATHER_H
#define MERLIN_NN_CPU_KERNELS_GATHER_H

#include "nn/cpu/kernels/kernels.h"

/* Points of images: column and row in float32, in pixels of pictures that are `reduction` times as large as the map,
 * where whole numbers are the pixels' centres. Points beyond the map's outermost centres are moved to them. The images
 * of a map are a multiple of the points' images: consecutive ones share points. */
typedef struct cpu_places {
    const cpu_tensor *at; /* n × 1 × points × 2 */
    int reduction;
} cpu_places;

/* Interpolates x bilinearly: y is n × 1 × points × C. */
void cpu_gather(const cpu_tensor *x, const cpu_places *places, cpu_tensor *y);
/* Adds each point's gradient to the pixels that it was interpolated from. sums: room for the floats of dx. */
void cpu_gather_backward(const cpu_places *places, const cpu_tensor *dy, cpu_tensor *dx, bool accumulate, float *sums);

#endif
