/* SPDX-License-Identifier: MIT */
/* Copies weights into a padded blocked layout by this project's own loop.
 *
 * The reorder of oneDNN 3 (seen in 3.7.2, with AVX-512) loses values where both channel counts are padded: of 3×3
 * kernels from 3 channels to 5 it writes 120 of 135 weights. Version 2, and layouts without padding, are not affected.
 */
#ifndef MERLIN_NN_CPU_DNN_DNN_PACK_H
#define MERLIN_NN_CPU_DNN_DNN_PACK_H

#include "nn/cpu/dnn/dnn_memory.h"

typedef struct dnn_packing dnn_packing;

/* Plans the copy of float32 weights in PyTorch's order (out, in, height, width) into a layout of float32 or bfloat16,
 * whose padding must be zero already. *out is NULL where oneDNN's reorder can be used. MERLIN_NO_MEMORY. */
status dnn_packing_new(const dnn_shape *from, const float *source, dnn_layout to, void *target, dnn_packing **out);
void dnn_packing_free(dnn_packing *packing);
void dnn_pack(const dnn_packing *packing);

#endif
