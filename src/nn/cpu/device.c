/* SPDX-License-Identifier: MIT */
/* The CPU as a device: oneDNN for convolutions, OpenMP loops for the rest. */
#ifdef __SSE__
#include <xmmintrin.h>
#endif

#include "base/memory.h"
#include "nn/cpu/dnn/dnn.h"
#include "nn/cpu/kernels/kernels.h"
#include "nn/cpu/kernels/steps.h"
#include "nn/cpu/tuning.h"

/* Sets flush-to-zero in every compute thread for the duration of a run: denormal numbers are a hundred times slower. */
static void begin(void *p)
{
#ifdef __SSE__
    dnn_context *context = p;
    context->control = _mm_getcsr();
#pragma omp parallel
    _mm_setcsr(_mm_getcsr() | 0x8040u); /* flush to zero, denormals are zero */
#else
    (void)p;
#endif
}

static void end(void *p)
{
#ifdef __SSE__
    /* in all threads, not this one alone: what others compute between runs must not depend on which thread does it */
    unsigned control = ((const dnn_context *)p)->control;
#pragma omp parallel
    _mm_setcsr(control);
#else
    (void)p;
#endif
}

static void convert(const nn_tensor *from, nn_tensor *to)
{
    cpu_cast(from, to, false);
}

const nn_device *cpu_device(void)
{
    static const nn_device device = {
        .usable_type = tuning_usable_type,
        .fastest_type = tuning_fastest_type,
        .open = dnn_open,
        .close = dnn_close,
        .create = step_create,
        .allocate = memory_new,
        .release = memory_free,
        .begin = begin,
        .end = end,
        .convert = convert,
        .adam = cpu_adam,
        .sum_squares = cpu_sum_squares,
        .measure_peak = cpu_measure_peak,
    };
    return &device;
}
