/* SPDX-License-Identifier: MIT */
/* Operations for which oneDNN has no primitive: forward and backward of elementwise, resampling, rendering and loss
 * operations on channels-last tensors, as short OpenMP loops.
 *
 * Every forward writes all of y. Every backward writes dx, or adds to it if `accumulate` is set because another use of
 * x has already written its gradient there. Tensors are float32 or bfloat16 (computed in float32); x, y and their
 * gradients share a type unless stated otherwise. Sizes must fit (the compiler of the graph has checked them). Results
 * do not depend on the number of threads. */
#ifndef MERLIN_NN_CPU_KERNELS_KERNELS_H
#define MERLIN_NN_CPU_KERNELS_KERNELS_H

#include <stdbool.h>
#include <stddef.h>

#include "nn/adam_step.h"
#include "nn/tensor.h"

enum { CPU_MAX_CHANNELS = 2048 }; /* the widest tensor these loops take: their buffers are on the stack */

typedef nn_tensor cpu_tensor;

static inline size_t cpu_count(const cpu_tensor *t)
{
    return tensor_count(t);
}

/* Computes y = x, converting the type; with accumulate y += x. Also the backward pass of a conversion. */
void cpu_cast(const cpu_tensor *x, cpu_tensor *y, bool accumulate);
void cpu_zero(cpu_tensor *x);

void cpu_relu(const cpu_tensor *x, cpu_tensor *y);
void cpu_relu_backward(const cpu_tensor *y, const cpu_tensor *dy, cpu_tensor *dx, bool accumulate);
void cpu_tanh(const cpu_tensor *x, cpu_tensor *y);
void cpu_tanh_backward(const cpu_tensor *y, const cpu_tensor *dy, cpu_tensor *dx, bool accumulate);
void cpu_sigmoid(const cpu_tensor *x, cpu_tensor *y);
void cpu_sigmoid_backward(const cpu_tensor *y, const cpu_tensor *dy, cpu_tensor *dx, bool accumulate);
void cpu_scale_shift(const cpu_tensor *x, cpu_tensor *y, float scale, float shift);
void cpu_scale_shift_backward(const cpu_tensor *dy, cpu_tensor *dx, float scale, bool accumulate);
void cpu_reciprocal(const cpu_tensor *x, cpu_tensor *y, float scale, float shift);
void cpu_reciprocal_backward(const cpu_tensor *y, const cpu_tensor *dy, cpu_tensor *dx, float scale, bool accumulate);

void cpu_add(const cpu_tensor *a, const cpu_tensor *b, cpu_tensor *y);
/* Copy x's channels to channels [first, first + x.c) of y, or from there to x (backward, slice). */
void cpu_insert_channels(const cpu_tensor *x, cpu_tensor *y, int first, bool accumulate);
void cpu_extract_channels(const cpu_tensor *y, int first, cpu_tensor *x, bool accumulate);

/* Computes y = x·gate, gate.c == 1. Backward: dx or dgate is NULL (or has no data) if it is not needed. */
void cpu_gate(const cpu_tensor *x, const cpu_tensor *gate, cpu_tensor *y);
void cpu_gate_backward(const cpu_tensor *x, const cpu_tensor *gate, const cpu_tensor *dy, cpu_tensor *dx,
                       bool accumulate_x, cpu_tensor *dgate, bool accumulate_gate);

void cpu_upsample_bilinear(const cpu_tensor *x, cpu_tensor *y);
void cpu_upsample_bilinear_backward(const cpu_tensor *dy, cpu_tensor *dx, bool accumulate);
/* Repeats a vector: x is N×1×1×C, y N×H×W×C. */
void cpu_tile(const cpu_tensor *x, cpu_tensor *y);
void cpu_tile_backward(const cpu_tensor *dy, cpu_tensor *dx, bool accumulate);
void cpu_space_to_depth(const cpu_tensor *x, cpu_tensor *y, int block, bool accumulate);
void cpu_depth_to_space(const cpu_tensor *x, cpu_tensor *y, int block, bool accumulate);

/* Averages over pixels: x is N×H×W×C, y N×1×1×C. */
void cpu_spatial_mean(const cpu_tensor *x, cpu_tensor *y);
void cpu_spatial_mean_backward(const cpu_tensor *dy, cpu_tensor *dx, bool accumulate);

/* ---- float32 only from here on ---- */
void cpu_normalize(const cpu_tensor *x, cpu_tensor *y);
void cpu_normalize_backward(const cpu_tensor *x, const cpu_tensor *y, const cpu_tensor *dy, cpu_tensor *dx,
                            bool accumulate);

typedef struct cpu_render_tensors {
    cpu_tensor albedo, normal, roughness, depth; /* values; or their gradients, data NULL if not needed */
} cpu_render_tensors;
typedef struct cpu_render_accumulate {
    bool albedo, normal, roughness, depth;
} cpu_render_accumulate;
/* Camera and light of the maps. */
typedef struct cpu_render_view {
    cpu_tensor mask, light, lens; /* lens.data NULL: the lens of fov for all samples */
    float fov, light_power;
} cpu_render_view;
void cpu_render(const cpu_render_tensors *maps, const cpu_render_view *view, cpu_tensor *y);
void cpu_render_backward(const cpu_render_tensors *maps, const cpu_render_view *view, const cpu_tensor *dy,
                         cpu_render_tensors *dmaps, cpu_render_accumulate accumulate);

typedef struct cpu_environment {
    cpu_tensor albedo, normal, sh; /* values; or their gradients, data NULL if not needed */
} cpu_environment;
typedef struct cpu_environment_accumulate {
    bool albedo, normal, sh;
} cpu_environment_accumulate;
void cpu_shade_environment(const cpu_environment *in, const cpu_tensor *mask, cpu_tensor *y);
void cpu_environment_backward(const cpu_environment *in, const cpu_tensor *mask, const cpu_tensor *dy,
                              cpu_environment *gradients, cpu_environment_accumulate accumulate);

/* Returns the loss; mask_sum receives ΣM for the backward pass. Sums are in double, in a fixed order. */
float cpu_masked_l2(const cpu_tensor *prediction, const cpu_tensor *target, const cpu_tensor *mask, double *mask_sum);
/* Computes d(scale · loss)/d(prediction). */
void cpu_masked_l2_backward(const cpu_tensor *prediction, const cpu_tensor *target, const cpu_tensor *mask,
                            double mask_sum, float scale, cpu_tensor *dprediction, bool accumulate);
float cpu_masked_gradient_l2(const cpu_tensor *prediction, const cpu_tensor *target, const cpu_tensor *mask,
                             double *mask_sum);
void cpu_masked_gradient_l2_backward(const cpu_tensor *prediction, const cpu_tensor *target, const cpu_tensor *mask,
                                     double mask_sum, float scale, cpu_tensor *dprediction, bool accumulate);

/* Computes structural dissimilarity. MERLIN_NO_MEMORY. */
status cpu_masked_dssim(const cpu_tensor *prediction, const cpu_tensor *target, const cpu_tensor *mask,
                        double *mask_sum, float *loss);
status cpu_masked_dssim_backward(const cpu_tensor *prediction, const cpu_tensor *target, const cpu_tensor *mask,
                                 double mask_sum, float scale, cpu_tensor *dprediction, bool accumulate);

void cpu_adam(const adam_step *step, size_t count, float *value, const float *gradient, float *moment1, float *moment2);
/* Returns Σ g² in double, in a fixed order; NaN or infinity if any element is. */
double cpu_sum_squares(const float *x, size_t count);

#endif
