/* SPDX-License-Identifier: MIT */
/* Convolutions of 3×3 with stride 1 and zero padding in a quarter of the multiplications: Winograd's minimal filtering
 * F(4×4, 3×3) (A. Lavin & S. Gray, Fast Algorithms for Convolutional Neural Networks, CVPR 2016). A tile of 6×6 values
 * is transformed to 36 others; each is multiplied by its counterpart of the kernel and summed over channels; the 36
 * sums are transformed to the 4×4 values of the result. The gradient of the weights is the transposed computation.
 *
 *     winograd g = {.n = 4, .h = 64, .w = 64, .in = 64, .out = 96, .threads = 2};
 *     winograd_transform(weight, g.in, g.out, u);                       u: winograd_weights(64, 96) floats
 *     winograd_convolve(&g, x, u, &(winograd_after){.bias = b}, y, room);    room: winograd_room(&g) floats
 *
 * Activations are float32 or bfloat16, sums and weights float32; activations channels-last, weights [out][in][3][3];
 * channels are multiples of WINOGRAD_CHANNELS and at most CPU_MAX_CHANNELS. The rounding error is some ten times that
 * of the plain sum (3e-6 of the result). Results do not depend on the number of threads. */
#ifndef MERLIN_NN_CPU_WINOGRAD_WINOGRAD_H
#define MERLIN_NN_CPU_WINOGRAD_WINOGRAD_H

#include "nn/cpu/winograd/winograd_shape.h"

size_t winograd_weights(int in, int out);

/* Transforms weights for the convolution of so many channels, and for its winograd_back. */
void winograd_transform(const float *weight, int in, int out, float *u);
void winograd_transform_back(const float *weight, int in, int out, float *u);

size_t winograd_room(const winograd *g);
void winograd_convolve(const winograd *g, const void *x, const float *u, const winograd_after *after, void *y,
                       float *room);

size_t winograd_gradient_room(const winograd *g);
/* Computes dw = d(loss)/d(weight) from dy = d(loss)/d(output). */
void winograd_gradient(const winograd *g, const void *x, const void *dy, float *dw, float *room);

#endif
