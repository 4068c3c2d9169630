/* SPDX-License-Identifier: MIT */
/* OpenMP of one thread: its pragmas are comments to a compiler that is not told of them. */
#ifndef MERLIN_BROWSER_OMP_H
#define MERLIN_BROWSER_OMP_H

static inline int omp_get_num_threads(void)
{
    return 1;
}

static inline int omp_get_thread_num(void)
{
    return 0;
}

static inline int omp_get_max_threads(void)
{
    return 1;
}

#endif
