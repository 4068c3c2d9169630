/* SPDX-License-Identifier: MIT */
/* Operations over the pictures of an object, which lie one behind another in the batch: a tensor of pictures has a
 * multiple of the images of a tensor of objects. As in kernels.h, every forward writes all of its result, and every
 * backward writes gradients or adds to them.
 *
 * present (NULL: all) has a float32 number for each picture: those that are not greater than 0 are left out, as if the
 * object had fewer pictures. They receive no gradient. Where no picture is left the result is zero. */
#ifndef MERLIN_NN_CPU_KERNELS_GROUP_H
#define MERLIN_NN_CPU_KERNELS_GROUP_H

#include "nn/cpu/kernels/kernels.h"

/* Most channels of one head of attention: its pictures' numbers are on the stack. */
enum { CPU_MAX_HEAD = NN_LARGEST_HEAD };

/* Computes the largest value of any picture; of equal ones, the first picture's receives the gradient. */
void cpu_group_max(const cpu_tensor *x, const cpu_tensor *present, cpu_tensor *y);
void cpu_group_max_backward(const cpu_tensor *x, const cpu_tensor *present, const cpu_tensor *y, const cpu_tensor *dy,
                            cpu_tensor *dx, bool accumulate);
void cpu_group_mean(const cpu_tensor *x, const cpu_tensor *present, cpu_tensor *y);
void cpu_group_mean_backward(const cpu_tensor *present, const cpu_tensor *dy, cpu_tensor *dx, bool accumulate);
/* Computes √(mean of squared differences from the mean + ε), whose slope stays finite where all pictures agree. */
void cpu_group_spread(const cpu_tensor *x, const cpu_tensor *present, cpu_tensor *y);
void cpu_group_spread_backward(const cpu_tensor *x, const cpu_tensor *present, const cpu_tensor *dy, cpu_tensor *dx,
                               bool accumulate);
/* Repeats an object's values for each of its pictures. */
void cpu_group_repeat(const cpu_tensor *x, cpu_tensor *y);
void cpu_group_repeat_backward(const cpu_tensor *dy, cpu_tensor *dx, bool accumulate);

/* Heads of attention, and how many pictures an object has. */
typedef struct cpu_heads {
    int count, pictures;
    const cpu_tensor *present;
} cpu_heads;

/* Computes scaled dot-product attention among the pictures, at each pixel on its own (Vaswani et al. 2017). x has
 * query, key and value one behind another, 3·C channels in all, y the C channels of all heads. */
void cpu_group_attention(const cpu_tensor *x, const cpu_heads *heads, cpu_tensor *y);
void cpu_group_attention_backward(const cpu_tensor *x, const cpu_heads *heads, const cpu_tensor *dy, cpu_tensor *dx,
                                  bool accumulate);
/* Computes attention with one learned query of C numbers instead of each picture's own. x: key and value, 2·C channels;
 * y: an object's C channels. */
void cpu_group_pool(const cpu_tensor *x, const cpu_heads *heads, const float *query, cpu_tensor *y);
/* dx may have no data. partial: room for CPU_PARTS·C floats. dquery is written. */
void cpu_group_pool_backward(const cpu_tensor *x, const cpu_heads *heads, const float *query, const cpu_tensor *dy,
                             cpu_tensor *dx, bool accumulate, float *partial, float *dquery);

#endif
