/* SPDX-License-Identifier: MIT */
/* Transforms a picture's tiles to Winograd's points and back: borders, types of activations and operations after the
 * convolution. Internal to winograd.c. */
#ifndef MERLIN_NN_CPU_WINOGRAD_WINOGRAD_TILES_H
#define MERLIN_NN_CPU_WINOGRAD_WINOGRAD_TILES_H

#include "nn/cpu/winograd/winograd_shape.h"

/* Transforms the window of a tile of the result from activations x to points `stride` floats apart. copy: room for
 * POINTS pixels of the input, used at the border. */
void winograd_take_window(const winograd *g, const void *x, size_t tile, void *copy, float *to, size_t stride);
/* Transforms a tile of the result's gradient dy to the points, the transpose of winograd_put_result. copy: room for a
 * tile of the output. */
void winograd_take_result_back(const winograd *g, const void *dy, size_t tile, void *copy, float *to, size_t stride);
/* Transforms the sums at a tile's points, `stride` floats apart, to its pixels of activations y. */
void winograd_put_result(const winograd *g, const float *from, size_t stride, const winograd_after *after, size_t tile,
                         void *y);

#endif
