/* SPDX-License-Identifier: MIT */
/* Memory planning by lifetime: buffers that are never in use at the same time share bytes of one arena. Internal to
 * src/nn. */
#ifndef MERLIN_NN_PLAN_H
#define MERLIN_NN_PLAN_H

#include <stddef.h>

#include "base/status.h"

enum { PLAN_ALIGNMENT = 64 };

typedef struct plan_buffer {
    size_t bytes;
    int first, last; /* steps of first write and last use, both included */
    size_t offset;   /* result, a multiple of PLAN_ALIGNMENT */
} plan_buffer;

/* Computes the offsets, and in *size the arena's bytes. Greedy by size, best fit (Pisarchyk & Lee 2020). */
status plan_memory(plan_buffer *buffers, size_t count, size_t *size);

#endif
