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
 * Activations are N×H×W×C (channels last) everywhere, on the device and at its interface. A node's precision is either
 * `float` (float32) or `compute` (the program's type: float32 or bfloat16); nn_compute and nn_float convert.
 * Convolution, fully connected and batch norm run in compute; the rendering layer, vector normalization, and losses
 * need float; every other operation follows its input.
 *
 * Builder functions return NULL after an error and accept NULL, so that a model is written without checks in between;
 * nn_compile and nn_params_new report the first error. Nodes are owned by their graph. */
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
/* Instead of a reduction: a vector, and values at sampled points. */
enum { NN_VECTOR = 0, NN_POINTS = -1 };

/* Adds a float32 input: N × H/reduction × W/reduction × channels; reduction NN_VECTOR means N × 1 × 1 × channels,
 * NN_POINTS N × 1 × points × channels. */
nn_node *nn_input(nn_graph *g, const char *name, int channels, int reduction);
/* Names a node whose value is kept after nn_forward (any precision; returned as float32). */
void nn_output(nn_graph *g, nn_node *x, const char *name);

nn_node *nn_compute(nn_graph *g, nn_node *x);
nn_node *nn_float(nn_graph *g, nn_node *x);

/* Adds a convolution with parameters `name.weight` (out × in × k × k, as in PyTorch) and `name.bias`. The result has
 * size/stride: padding is (k - 1)/2 before, the rest behind. */
nn_node *nn_conv2d(nn_graph *g, nn_node *x, const char *name, int out, int kernel, int stride, nn_bias bias);
/* Adds a convolution whose weights start at 0: its result is zero until it is trained, so that it can be added to a
 * network that is trained already. */
nn_node *nn_conv2d_zero(nn_graph *g, nn_node *x, const char *name, int out, int kernel, int stride, nn_bias bias);
/* Adds a convolution of stride 1 between whose taps are dilation - 1 pixels: padding is half of (k - 1) dilation. */
nn_node *nn_conv2d_dilated(nn_graph *g, nn_node *x, const char *name, int out, int kernel, int dilation, nn_bias bias);
/* Adds a transposed convolution, the adjoint of nn_conv2d with this kernel and stride, without bias (batch norm is to
 * follow): parameter `name.weight` (in × out × k × k, as in PyTorch's ConvTranspose2d with padding (k - stride)/2,
 * which must be whole). The result has size·stride. */
nn_node *nn_conv2d_transposed(nn_graph *g, nn_node *x, const char *name, int out, int kernel, int stride);
/* Adds a fully connected layer on vectors (1×1): `name.weight` out × in, `name.bias`. */
nn_node *nn_linear(nn_graph *g, nn_node *x, const char *name, int out);
/* Adds batch normalization per channel over N, H, W (Ioffe & Szegedy 2015); eps 1e-5, running statistics by
 * nn_set_norm_momentum. Parameters `name.weight`, `name.bias`, `name.running_mean`, `name.running_var`. */
nn_node *nn_batch_norm(nn_graph *g, nn_node *x, const char *name);
/* Adds batch normalization whose weight starts at 0 instead of 1: a residual branch that ends in it is zero at first
 * (Goyal et al. 2017), so that it can be added to a network that is trained already. */
nn_node *nn_batch_norm_zero(nn_graph *g, nn_node *x, const char *name);
nn_node *nn_relu(nn_graph *g, nn_node *x);
nn_node *nn_tanh(nn_graph *g, nn_node *x);
nn_node *nn_sigmoid(nn_graph *g, nn_node *x);
nn_node *nn_concat(nn_graph *g, nn_node *const *x, int count);
nn_node *nn_slice(nn_graph *g, nn_node *x, int first, int channels);
nn_node *nn_add(nn_graph *g, nn_node *a, nn_node *b);
/* Passes x on, but no gradient back: what follows learns without changing what made x. */
nn_node *nn_stop(nn_graph *g, nn_node *x);
/* Multiplies x by a gate of one channel: attention (Oktay et al. 2018). */
nn_node *nn_gate(nn_graph *g, nn_node *x, nn_node *gate);
nn_node *nn_scale_shift(nn_graph *g, nn_node *x, float scale, float shift);
/* Doubles the size; half-pixel centres, edges repeated. */
nn_node *nn_upsample_bilinear(nn_graph *g, nn_node *x);
/* Repeats a vector over the spatial size of `like`. */
nn_node *nn_tile(nn_graph *g, nn_node *x, nn_node *like);
/* Rearrange N×H×W×C to N×H/b×W/b×(b·b·C), channel order (row, column, c), and back (Shi et al. 2016). */
nn_node *nn_space_to_depth(nn_graph *g, nn_node *x, int block);
nn_node *nn_depth_to_space(nn_graph *g, nn_node *x, int block);
/* Averages over rows and columns: a vector. */
nn_node *nn_spatial_mean(nn_graph *g, nn_node *x);
/* Normalizes 3-vectors per pixel; those shorter than 1e-6 become x·1e6. */
nn_node *nn_normalize(nn_graph *g, nn_node *x);
/* Computes 1 / (scale·x + shift): depth from the network's range, for example. */
nn_node *nn_reciprocal(nn_graph *g, nn_node *x, float scale, float shift);

/* ---- several pictures of an object ----
 *
 * A program's batch consists of objects, each with nn_options.group pictures one behind another. Nodes are of pictures,
 * unless they come from nn_group_input or from an operation below whose result is of objects; operations with several
 * inputs take only inputs of one kind. Pictures for which `present` (an input of pictures, NN_VECTOR, 1 channel; NULL:
 * all) is not positive are left out, so that one program serves fewer pictures, too. A result for an object without
 * pictures is zero. */

enum { NN_LARGEST_GROUP = 64, NN_LARGEST_HEAD = 64 };

/* Adds a float32 input of objects: N/group × H/reduction × W/reduction × channels. */
nn_node *nn_group_input(nn_graph *g, const char *name, int channels, int reduction);
/* Take each value's largest, mean, and standard deviation (of the population) over an object's pictures: of objects. */
nn_node *nn_group_max(nn_graph *g, nn_node *x, nn_node *present);
nn_node *nn_group_mean(nn_graph *g, nn_node *x, nn_node *present);
nn_node *nn_group_spread(nn_graph *g, nn_node *x, nn_node *present);
/* Repeats an object's values for each of its pictures. */
nn_node *nn_group_repeat(nn_graph *g, nn_node *x);
/* Adds scaled dot-product attention among an object's pictures, for each pixel on its own (Vaswani et al. 2017). x:
 * query, key and value as three equal parts of its channels, each divided among the heads; the result has a third of
 * the channels. At most NN_LARGEST_HEAD channels a head. */
nn_node *nn_group_attention(nn_graph *g, nn_node *x, nn_node *present, int heads);
/* Adds attention with a learned query, parameter `name.weight`, which is zero at first, so that the result is the mean
 * then. x: key and value as two equal parts of its channels; the result, of objects, has half of the channels. */
nn_node *nn_group_pool(nn_graph *g, nn_node *x, nn_node *present, const char *name, int heads);
/* Normalizes each pixel over its channels (Ba et al. 2016); eps 1e-5. Parameters `name.weight`, `name.bias`. */
nn_node *nn_layer_norm(nn_graph *g, nn_node *x, const char *name);
/* Interpolates x bilinearly at points: the result is NN_POINTS, on which 1×1 convolutions, norms, attention and masked
 * L2 losses work. places (float, NN_POINTS, of pictures or objects): column and row in pixels of a picture of the
 * program's size, where whole numbers are pixels' centres. No gradient flows to places. */
nn_node *nn_gather(nn_graph *g, nn_node *x, nn_node *places);

/* The inputs of the rendering layer (the paper's Eq. 2 and 3, the BRDF of src/optics/brdf.h): radiance of the object
 * under one point light, clipped to [0, 1] and multiplied by the mask. albedo (3) and roughness (1) in [-1, 1] as
 * inside the network, normal (3) unit, depth (1) in scene units, mask (1), light (vector of 3: position in camera
 * space), all float. The field of view is in degrees, horizontal, of a square frame. No gradient flows to mask, light
 * and lens.
 *
 * lens (a vector of 3, or NULL: the lens of fov for all): the tangent of half of a sample's field of view, and its
 * slant to the right and upwards (optics/camera.h). Depth then measures relief in widths of the frame, as the picture
 * shows it: the distance is 1 + (depth - 1) · tangent / tangent of fov's half. */
typedef struct nn_render_inputs {
    nn_node *albedo, *normal, *roughness, *depth, *mask, *light, *lens;
} nn_render_inputs;
nn_node *nn_render(nn_graph *g, const nn_render_inputs *in, float fov, float light_power);
/* Adds what the diffuse part of the same maps reflects of an environment given by spherical harmonics
 * (src/optics/sh.h): albedo/π · irradiance, times the mask. It is not clipped: three bands of a bright spot ring
 * slightly below zero, and the layer stays linear in sh. sh: vector of 27, coefficient by coefficient, three channels
 * each. No gradient flows to mask. */
nn_node *nn_environment(nn_graph *g, nn_node *albedo, nn_node *normal, nn_node *mask, nn_node *sh);

/* Add losses: scalars, whose weighted sum is the program's total. mask has one channel. (1/ΣM) Σ ((prediction - target)
 * M)², summed over channels: the paper's Eq. 6. */
void nn_masked_l2(nn_graph *g, nn_node *prediction, nn_node *target, nn_node *mask, const char *name, float weight);
/* Adds the same loss of horizontal and vertical forward differences where both pixels are inside the mask (> 0.5). */
void nn_masked_gradient_l2(nn_graph *g, nn_node *prediction, nn_node *target, nn_node *mask, const char *name,
                           float weight);

/* Adds (1/ΣM) Σ (1 - SSIM) / channels over the windows around all pixels, of prediction and target times the mask:
 * structural similarity (Wang et al. 2004) as merlin-lab eval measures it, except that windows reach beyond the frame,
 * which is black there. */
void nn_masked_dssim(nn_graph *g, nn_node *prediction, nn_node *target, nn_node *mask, const char *name, float weight);

/* ---- parameters ---- */

struct safetensors_file; /* nn/safetensors.h */

/* Makes initial parameters for a graph: convolutions He 2015, gamma 1, beta 0, biases 0. Deterministic from seed. */
status nn_params_new(const nn_graph *g, uint64_t seed, nn_params **out);
/* Makes parameters from an open safetensors file, as nn_params_load does; path for messages. They are for programs of
 * NN_INFER only: weights that the file stores as half floats are kept so, in half the memory. */
status nn_params_open(const nn_graph *g, const struct safetensors_file *f, const char *path, nn_params **out);
void nn_params_free(nn_params *params);
size_t nn_params_count(const nn_params *params);

typedef struct nn_param {
    const char *name;
    int rank;
    int64_t shape[4];
    size_t count;
    size_t place;              /* where its values begin among all parameters' (nn_params_values) */
    float *value;              /* float32 master; NULL if `half` has the values */
    uint16_t *half;            /* NULL except for weights of nn_params_open */
    float *gradient;           /* set by nn_backward; NULL for running statistics */
    bool decays;               /* weights of convolutions and fully connected layers: see nn_adam_options */
    float learning_rate_scale; /* multiplies Adam's rate; 1 unless nn_params_scale_rate said otherwise */
} nn_param;
nn_param *nn_params_at(nn_params *params, size_t i);
/* Returns the number of values of all parameters, with padding between them: for arrays with a number beside each
 * value. */
size_t nn_params_values(const nn_params *params);
nn_param *nn_params_find(nn_params *params, const char *name);
void nn_params_scale_rate(nn_params *params, const char *prefix, float scale);
/* Announces that values were changed from outside: programs update their copies at their next run. */
void nn_params_touch(nn_params *params);

/* Copies the tensors of a safetensors file (nn/safetensors.h; F32, F16 or BF16) into parameters of the same names.
 * Missing, extra or differently shaped tensors are an error that names one. */
status nn_params_load(nn_params *params, const char *path);
/* Copies what fits by name and shape from another model's file; other parameters keep their values. If nothing fits,
 * that is an error. */
status nn_params_load_shared(nn_params *params, const char *path);

/* ---- programs ---- */

typedef enum nn_type { NN_FLOAT32, NN_BFLOAT16 } nn_type;
typedef enum nn_purpose {
    NN_INFER, /* batch norm by running statistics, folded into the convolution before it */
    NN_TRAIN, /* batch statistics; nn_backward works */
} nn_purpose;
/* Which 3×3 convolutions are computed by Winograd's filtering: those measured to be faster on processors of this kind
 * or, to measure that, none or all that can be. */
typedef enum nn_filtering { NN_FILTER_FASTER, NN_FILTER_NONE, NN_FILTER_ALL } nn_filtering;

typedef struct nn_options {
    int batch, height, width; /* batch: pictures in all, a multiple of group */
    int group;                /* pictures of each object, up to NN_LARGEST_GROUP; 0: 1 */
    int points;               /* of an image that is sampled by nn_gather; 0: none is */
    nn_type type;
    nn_purpose purpose;
    const char *const *outputs; /* names, ended by NULL, of the only outputs to be computed; NULL: all */
    /* NULL, or a program whose memory for activations this one shares, if that is large enough. They must not run at
     * the same time, and compiling or running either destroys the other's inputs and outputs. */
    const nn_program *beside;
    nn_filtering filtering;
    /* NULL, or ranks whose batches together are one batch: batch norm, losses and gradients are those of all together,
     * the same bits in each. All ranks have the same options and parameters. */
    const ranks *together;
} nn_options;

status nn_compile(const nn_graph *g, nn_params *params, const nn_options *options, nn_program **out);
void nn_program_free(nn_program *p);
/* Returns the type that is computed in: float32 if bfloat16 was asked for and the processor lacks AVX-512. */
nn_type nn_program_type(const nn_program *p);

/* Return host buffers of the whole batch, N×H×W×C float32; NULL for an unknown name. An input that no requested output
 * depends on has a buffer, too. */
float *nn_input_data(nn_program *p, const char *name);
const float *nn_output_data(nn_program *p, const char *name);

status nn_forward(nn_program *p);
/* Computes the gradients of the weighted sum of all losses by the parameters, zeroed first. Once after each nn_forward,
 * NN_TRAIN only. */
status nn_backward(nn_program *p);
/* Share by which a training program's batch norms move their running statistics toward a batch's: NN_NORM_MOMENTUM
 * unless set, in (0, 1]. 1, 1/2, 1/3, … over as many batches gives their plain mean. */
#define NN_NORM_MOMENTUM 0.1f
void nn_set_norm_momentum(nn_program *p, float momentum);
/* Replaces the weight that a loss was built with; an unknown name is ignored. */
void nn_set_loss_weight(nn_program *p, const char *name, float weight);
/* Returns a loss's unweighted value after nn_forward; NAN for an unknown name. */
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
    const char *pass;      /* "forward", "refresh" (converting its parameters) or "backward" */
    const char *operation; /* "conv2d" */
    const char *name;
    int n, h, w, c; /* shape of the result; for a loss, of its prediction */
    double seconds; /* best of the runs, as other work may slow some */
    double flops;   /* of convolutions and fully connected layers, 2 per multiply-add */
} nn_layer;
typedef status nn_layer_seen(void *context, const nn_layer *layer);
/* Measures every step, to find what is slow; a status other than OK from `seen` ends it. Changes running statistics and
 * gradients. */
status nn_measure_layers(nn_program *p, int runs, nn_layer_seen *seen, void *context);

/* Peak rate in FLOP/s of this machine's convolutions, measured now: 64→64, 3×3, 128×128, batch 8. */
typedef struct nn_peak {
    double forward, backward_data, backward_weights;
} nn_peak;
status nn_measure_peak(nn_type type, nn_peak *out);
/* Returns the type in which this machine's convolutions are faster. */
nn_type nn_fastest_type(void);

/* ---- Adam (Kingma & Ba 2015) ---- */

typedef struct nn_adam_options {
    float beta1, beta2, epsilon;
    float clip_norm; /* gradients are scaled down to this global L2 norm; 0: never */
    /* Share of a weight that is taken off at each step per unit of learning rate (Loshchilov & Hutter 2019); not of
     * biases, norms and the query of nn_group_pool. 0: none. */
    float weight_decay;
} nn_adam_options;
status nn_adam_new(nn_params *params, const nn_adam_options *options, nn_adam **out);
void nn_adam_free(nn_adam *adam);
/* Takes one step with the gradients in params. If a gradient is NaN, infinite, or so large that its square would be,
 * the step is skipped and counted. */
status nn_adam_step(nn_adam *adam, float learning_rate);
/* Access for checkpoints: step count, skipped count and per-parameter moments (same order and sizes as params). */
int64_t nn_adam_steps(const nn_adam *adam);
int64_t nn_adam_skipped(const nn_adam *adam);
void nn_adam_set_steps(nn_adam *adam, int64_t steps, int64_t skipped);
float *nn_adam_moment(nn_adam *adam, size_t param, int which /* 1 or 2 */);

#endif
