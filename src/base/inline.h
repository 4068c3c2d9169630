/* SPDX-License-Identifier: MIT */
/* A loop with a call in it does not become vectors: what its body calls must be inlined, whatever its size. */
#ifndef MERLIN_BASE_INLINE_H
#define MERLIN_BASE_INLINE_H

#define ALWAYS_INLINE static inline __attribute__((always_inline))

#endif
