/* SPDX-License-Identifier: MIT */
/* Forces inlining: a loop vectorizes only if the functions it calls are inlined, whatever their size. */
#ifndef MERLIN_BASE_INLINE_H
#define MERLIN_BASE_INLINE_H

#define ALWAYS_INLINE static inline __attribute__((always_inline))

#endif
