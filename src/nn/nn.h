/* SPDX-License-Identifier: MIT */
/* The network engine: build a graph of named nodes, compile it for a device, a batch, a size and a purpose, run it.
 *
 *     nn_graph *g = nn_graph_new();
 *     nn_node *x = nn_input(g, "image", 4, 1);
 *     nn_node *y = nn_conv2d(g, nn_compute(g, x), "encoder.conv1", 32, 3, 1, NN_NO_BIAS);
 *     y = nn_relu(g, nn_batch_norm(g, y, "encoder.bn1"));
 *     nn_output(g, nn_float(g, y), "features");
 *     nn_params *params; nn_params_new(g, seed, &params);
 *     nn_program *p; nn_compile(g, params, &(nn_options){.batch = 8, .height = 128, .width = 128}, &p);
 *     memcpy(nn_input_data(p, "image"), ...); nn_forward(p); use(nn_output_data(p, "features"));
 *
 * Activations are N×H×W×C (channels last) everywhere, on the device and at its edges. A node's precision is either
 * `float` (float32) or `compute` (the program's type: float32 or bfloat16); nn_compute and nn_float convert.
 * Convolution, fully connected and batch norm run in compute; the rendering layer, vector
 * normalization, and losses need float; every other operation follows its input.
 *
 * Builder functions return NULL after an error and take NULL quietly, so that a model is written without checks in
 * between; nn_compile and nn_params_new report the first error. Nodes are owned by their graph. */
#ifndef MERLIN_NN_NN_H
#define MERLIN_NN_NN_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/ranks/ranks.h"
#include "base/status.h"

typedef struct nn_graph nn_graph;
typedef struct nn_node nn_node;
typedef struct nn_params nn_params;
typedef struct nn_program nn_program;
typedef struct nn_adam nn_adam;

/* ---- building ---- */

nn_graph *nn_graph_new(void);
void nn_graph_free(nn_graph *g);

typedef enum nn_bias { NN_NO_BIAS, NN_BIAS } nn_bias;
enum { NN_VECTOR = 0 };

/* A float32 input: N × H/reduction × W/reduction × channels; reduction NN_VECTOR means N × 1 × 1 × channels. */
nn_node *nn_input(nn_graph *g, const char *name, int channels, int reduction);
/* Names a node whose value is wanted after nn_forward (any precision; handed out as float32). */
void nn_output(nn_graph *g, nn_node *x, const char *name);

nn_node *nn_compute(nn_graph *g, nn_node *x);
nn_node *nn_float(nn_graph *g, nn_node *x);

/* Parameters `name.weight` (out × in × k × k, like PyTorch) and `name.bias`. Padding keeps size/stride: (k - 1)/2
 * before, the rest behind. */
nn_node *nn_conv2d(nn_graph *g, nn_node *x, const char *name, int out, int kernel, int stride, nn_bias bias);
/* The same with weights that start at 0: what it gives is nothing until it is trained, so that it can be added beside
 * what is trained already. */
nn_node *nn_conv2d_zero(nn_graph *g, nn_node *x, const char *name, int out, int kernel, int stride, nn_bias bias);
/* On vectors (1×1): `name.weight` out × in, `name.bias`. */
nn_node *nn_linear(nn_graph *g, nn_node *x, const char *name, int out);
/* Per channel over N, H, W (Ioffe & Szegedy 2015); eps 1e-5, running statistics as nn_set_norm_momentum says.
 * `name.weight`, `name.bias`, `name.running_mean`, `name.running_var`. */
nn_node *nn_batch_norm(nn_graph *g, nn_node *x, const char *name);
/* The same with a weight that starts at 0 instead of 1: a residual branch that ends in it begins as nothing (Goyal et
 * al. 2017), so that it can be added to a network that is trained already. */
nn_node *nn_batch_norm_zero(nn_graph *g, nn_node *x, const char *name);
nn_node *nn_relu(nn_graph *g, nn_node *x);
nn_node *nn_tanh(nn_graph *g, nn_node *x);
nn_node *nn_sigmoid(nn_graph *g, nn_node *x);
nn_node *nn_concat(nn_graph *g, nn_node *const *x, int count);
nn_node *nn_slice(nn_graph *g, nn_node *x, int first, int channels);
nn_node *nn_add(nn_graph *g, nn_node *a, nn_node *b);
/* x · gate, the gate with one channel: attention (Oktay et al. 2018). */
nn_node *nn_gate(nn_graph *g, nn_node *x, nn_node *gate);
nn_node *nn_scale_shift(nn_graph *g, nn_node *x, float scale, float shift);
/* Twice the size; half-pixel centres, edges repeated. */
nn_node *nn_upsample_bilinear(nn_graph *g, nn_node *x);
/* A vector repeated over the spatial size of `like`. */
nn_node *nn_tile(nn_graph *g, nn_node *x, nn_node *like);
/* N×H×W×C to N×H/b×W/b×(b·b·C), channel order (row, column, c); and back (Shi et al. 2016). */
nn_node *nn_space_to_depth(nn_graph *g, nn_node *x, int block);
nn_node *nn_depth_to_space(nn_graph *g, nn_node *x, int block);
/* Mean over rows and columns: a vector. */
nn_node *nn_spatial_mean(nn_graph *g, nn_node *x);
/* Unit 3-vectors per pixel; of what is shorter than 1e-6, x·1e6. */
nn_node *nn_normalize(nn_graph *g, nn_node *x);
/* 1 / (scale·x + shift): depth from the network's range, for example. */
nn_node *nn_reciprocal(nn_graph *g, nn_node *x, float scale, float shift);
/* The rendering layer (the paper's Eq. 2 and 3, the BRDF of src/optics/brdf.h): radiance of the object under one point
 * light, clipped to [0, 1] and multiplied by the mask. albedo (3) and roughness (1) in [-1, 1] as inside the network,
 * normal (3) unit, depth (1) in scene units, mask (1), light (vector of 3: position in camera space), all float.
 * field of view in degrees, horizontal, square frame. No gradient flows to mask, light and lens.
 *
 * lens (a vector of 3, or NULL: that of fov for all): the tangent of half of a sample's field of view, and its slant to
 * the right and upwards (optics/camera.h). Depth then counts relief in widths of the frame, as the picture shows it:
 * the distance is 1 + (depth - 1) · tangent / tangent of fov's half. */
typedef struct nn_render_inputs {
    nn_node *albedo, *normal, *roughness, *depth, *mask, *light, *lens;
} nn_render_inputs;
nn_node *nn_render(nn_graph *g, const nn_render_inputs *in, float fov, float light_power);
/* What the diffuse part of the same maps reflects of an environment known by their spherical harmonics
 * (src/optics/sh.h): albedo/π · irradiance, times the mask, not clipped: three bands of a bright spot ring below zero a
 * little, and the layer stays linear in sh. sh: vector of 27, coefficient by coefficient, three channels each. No
 * gradient flows to mask. */
nn_node *nn_environment(nn_graph *g, nn_node *albedo, nn_node *normal, nn_node *mask, nn_node *sh);

/* Losses: scalars, summed with their weights into the program's total. mask has one channel.
 * (1/ΣM) Σ ((prediction - target) M)², summed over channels: the paper's Eq. 6. */
void nn_masked_l2(nn_graph *g, nn_node *prediction, nn_node *target, nn_node *mask, const char *name, float weight);
/* The same over horizontal and vertical forward differences, where both pixels are inside the mask (> 0.5). */
void nn_masked_gradient_l2(nn_graph *g, nn_node *prediction, nn_node *target, nn_node *mask, const char *name,
                           float weight);

/* (1/ΣM) Σ (1 - SSIM) / channels over the windows around all pixels, of prediction and target times the mask:
 * structural similarity (Wang et al. 2004) as merlin-lab eval measures it, but that windows reach beyond the frame,
 * into black. */
void nn_masked_dssim(nn_graph *g, nn_node *prediction, nn_node *target, nn_node *mask, const char *name, float weight);

/* ---- parameters ---- */

struct safetensors_file; /* nn/safetensors.h */

/* Fresh parameters for a graph: convolutions He 2015, gamma 1, beta 0, biases 0. Deterministic from seed. */
status nn_params_new(const nn_graph *g, uint64_t seed, nn_params **out);
/* Those of a safetensors file that is open already, as nn_params_load has them; path for messages. They are for
 * programs of NN_INFER alone: weights that the file has as half floats stay such, in half the memory. */
status nn_params_open(const nn_graph *g, const struct safetensors_file *f, const char *path, nn_params **out);
void nn_params_free(nn_params *params);
size_t nn_params_count(const nn_params *params);

typedef struct nn_param {
    const char *name;
    int rank;
    int64_t shape[4];
    size_t count;
    size_t place;              /* where its values begin among all parameters' (nn_params_values) */
    float *value;              /* float32 master; NULL where half has it */
    uint16_t *half;            /* NULL but for weights of nn_params_open */
    float *gradient;           /* filled by nn_backward; NULL for running statistics */
    float learning_rate_scale; /* multiplies Adam's rate; 1 unless nn_params_scale_rate said otherwise */
} nn_param;
nn_param *nn_params_at(nn_params *params, size_t i);
/* How many values all have, with room between parameters: for a number beside each value. */
size_t nn_params_values(const nn_params *params);
nn_param *nn_params_find(nn_params *params, const char *name);
void nn_params_scale_rate(nn_params *params, const char *prefix, float scale);
/* After values were changed from outside: programs pick them up at their next run. */
void nn_params_touch(nn_params *params);

/* Copies the tensors of a safetensors file (nn/safetensors.h; F32, F16 or BF16) into same-named parameters. Missing,
 * extra or differently shaped tensors are an error that names one. */
status nn_params_load(nn_params *params, const char *path);
/* From another model's file: what fits by name and shape; the rest stays as it is. Nothing that fits is an error. */
status nn_params_load_shared(nn_params *params, const char *path);

/* ---- programs ---- */

typedef enum nn_type { NN_FLOAT32, NN_BFLOAT16 } nn_type;
typedef enum nn_purpose {
    NN_INFER, /* batch norm by running statistics, folded into the convolution before it */
    NN_TRAIN, /* batch statistics; nn_backward works */
} nn_purpose;
/* The 3×3 convolutions that are computed by Winograd's filtering: those that are faster so by what was measured on a
 * processor of this kind, or, to measure it, none or all that can be. */
typedef enum nn_filtering { NN_FILTER_FASTER, NN_FILTER_NONE, NN_FILTER_ALL } nn_filtering;

typedef struct nn_options {
    int batch, height, width;
    nn_type type;
    nn_purpose purpose;
    const char *const *outputs; /* names that end with NULL: these alone are computed; NULL: all */
    /* NULL, or a program whose memory for activations this one uses too, if that is large enough. They must not run at
     * once, and compiling or running either leaves nothing in the other's inputs and outputs. */
    const nn_program *beside;
    nn_filtering filtering;
    /* NULL, or ranks whose batches are parts of one: batch norm, losses and gradients are those of all together, the
     * same bits in each. All have the same options and parameters. */
    const ranks *together;
} nn_options;

status nn_compile(const nn_graph *g, nn_params *params, const nn_options *options, nn_program **out);
void nn_program_free(nn_program *p);
/* The type it computes in: float32 where bfloat16 was asked for and the processor lacks AVX-512. */
nn_type nn_program_type(const nn_program *p);

/* Host buffers of the whole batch, N×H×W×C float32; NULL for an unknown name. An input that feeds nothing that is
 * wanted still has a buffer. */
float *nn_input_data(nn_program *p, const char *name);
const float *nn_output_data(nn_program *p, const char *name);

status nn_forward(nn_program *p);
/* Gradients of the weighted sum of all losses into the parameters, zeroed first. Once after each nn_forward,
 * NN_TRAIN only. */
status nn_backward(nn_program *p);
/* How far a training program's batch norms move their running statistics toward a batch's: NN_NORM_MOMENTUM unless set,
 * in (0, 1]. 1, 1/2, 1/3, … over as many batches gives their plain mean. */
#define NN_NORM_MOMENTUM 0.1f
void nn_set_norm_momentum(nn_program *p, float momentum);
/* Replaces the weight that a loss was built with; an unknown name changes nothing. */
void nn_set_loss_weight(nn_program *p, const char *name, float weight);
/* After nn_forward: a loss's unweighted value; NAN for an unknown name. */
float nn_loss(const nn_program *p, const char *name);
float nn_total_loss(const nn_program *p);

typedef struct nn_cost {
    /* of convolutions and fully connected layers, 2 per multiply-add, whole batch */
    double forward_flops, backward_flops;
    size_t activation_bytes, workspace_bytes, parameter_bytes;
    size_t parameter_count;
} nn_cost;
nn_cost nn_program_cost(const nn_program *p);
/* One step's work in one pass. Strings live as long as the program. */
typedef struct nn_layer {
    const char *pass;      /* "forward", "refresh" (its parameters' copies made anew) or "backward" */
    const char *operation; /* "conv2d" */
    const char *name;
    int n, h, w, c; /* of the result; of a loss, of what it is a loss of */
    double seconds; /* the best of the runs: others may be using the machine */
    double flops;   /* of convolutions and fully connected layers, 2 per multiply-add */
} nn_layer;
typedef status nn_layer_seen(void *context, const nn_layer *layer);
/* Tells what every step takes, for finding what is slow; a status other than OK from `seen` ends it. Changes running
 * statistics and gradients. */
status nn_measure_layers(nn_program *p, int runs, nn_layer_seen *seen, void *context);

/* Peak rate in FLOP/s of this machine's convolutions, measured now: 64→64, 3×3, 128×128, batch 8. */
typedef struct nn_peak {
    double forward, backward_data, backward_weights;
} nn_peak;
status nn_measure_peak(nn_type type, nn_peak *out);
/* The type in which this machine's convolutions are faster. */
nn_type nn_fastest_type(void);

/* ---- Adam (Kingma & Ba 2015) ---- */

typedef struct nn_adam_options {
    float beta1, beta2, epsilon;
    float clip_norm; /* gradients are scaled down to this global L2 norm; 0: never */
} nn_adam_options;
status nn_adam_new(nn_params *params, const nn_adam_options *options, nn_adam **out);
void nn_adam_free(nn_adam *adam);
/* One step with the gradients in params; a gradient with NaN or infinity, or one so large that its square would be,
 * skips the step and is counted. */
status nn_adam_step(nn_adam *adam, float learning_rate);
/* For checkpoints: step count, skipped count and per-parameter moments (same order and sizes as params). */
int64_t nn_adam_steps(const nn_adam *adam);
int64_t nn_adam_skipped(const nn_adam *adam);
void nn_adam_set_steps(nn_adam *adam, int64_t steps, int64_t skipped);
float *nn_adam_moment(nn_adam *adam, size_t param, int which /* 1 or 2 */);

#endif
