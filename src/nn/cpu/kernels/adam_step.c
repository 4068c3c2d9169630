/* SPDX-License-Identifier: MIT */
/* Adam's arithmetic on one parameter tensor. */
#include "nn/cpu/kernels/kernels.h"

#include <math.h>

#include "nn/cpu/kernels/chunk.h"

void cpu_adam(const adam_step *step, size_t count, float *value, const float *gradient, float *moment1, float *moment2)
{
    float b1 = step->beta1, b2 = step->beta2, rate = step->learning_rate / step->correction1;
    float second = 1 / step->correction2, scale = step->gradient_scale, epsilon = step->epsilon;
    const float kept = step->kept;
#pragma omp parallel for simd schedule(static) if (count > CPU_PARALLEL_MIN)
    for (size_t i = 0; i < count; i++) {
        float g = gradient[i] * scale;
        float m = b1 * moment1[i] + (1 - b1) * g;
        float v = b2 * moment2[i] + (1 - b2) * g * g;
        moment1[i] = m;
        moment2[i] = v;
        value[i] = kept * value[i] - rate * m / (sqrtf(v * second) + epsilon);
    }
}

double cpu_sum_squares(const float *x, size_t count)
{
    enum { BLOCKS = 64 };
    double partial[BLOCKS] = {0}, total = 0;
#pragma omp parallel for schedule(static) if (count > CPU_PARALLEL_MIN)
    for (size_t b = 0; b < BLOCKS; b++) {
        double sum = 0;
#pragma omp simd reduction(+ : sum)
        for (size_t i = count * b / BLOCKS; i < count * (b + 1) / BLOCKS; i++)
            sum += (double)x[i] * (double)x[i];
        partial[b] = sum;
    }
    for (size_t b = 0; b < BLOCKS; b++)
        total += partial[b];
    return total;
}
