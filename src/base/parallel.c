#include "base/parallel.h"

#include <omp.h>

void parallel_for(size_t count, void (*body)(void *context, size_t i), void *context)
{
#pragma omp parallel for schedule(dynamic, 1)
    for (size_t i = 0; i < count; i++)
        body(context, i);
}

void parallel_blocks(size_t count, void (*body)(void *context, size_t begin, size_t end), void *context)
{
#pragma omp parallel
    {
        size_t threads = (size_t)omp_get_num_threads(), t = (size_t)omp_get_thread_num();
        size_t begin = count * t / threads, end = count * (t + 1) / threads;
        if (begin < end) body(context, begin, end);
    }
}

int parallel_threads(void)
{
    return omp_get_max_threads();
}

void parallel_set_threads(int count)
{
    omp_set_num_threads(count);
}
