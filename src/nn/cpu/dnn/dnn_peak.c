/* SPDX-License-Identifier: MIT */
/* The machine's peak rate, measured by a convolution of the most favourable shape. */
#include <string.h>

#include "base/memory.h"
#include "base/progress.h"
#include "nn/cpu/dnn/dnn.h"
#include "nn/cpu/kernels/steps.h"

typedef status (*pass)(nn_step *step);

/* Returns the best rate of many runs, after one to warm up: other work on the machine only slows some of them. */
static status best_rate(nn_step *step, pass run, double flops, double *rate)
{
    enum { RUNS = 24 };
    *rate = 0;
    for (int r = 0; r < RUNS; r++) {
        double start = clock_seconds();
        status s = run(step);
        double seconds = clock_seconds() - start;
        if (s != OK) return s;
        if (r > 0 && flops / seconds > *rate) *rate = flops / seconds;
    }
    return OK;
}

/* Allocates memory and writes to it: untouched pages all map to one page of zeros, which would always be in the cache.
 */
static void *new_written(size_t bytes)
{
    void *memory = memory_new(bytes);
    if (memory) memset(memory, 0, bytes);
    return memory;
}

static status allocate_tensors(nn_step *step, void *memory[6])
{
    nn_tensor *tensors[] = {&step->in[0], &step->out, &step->in_gradient[0], &step->out_gradient};
    for (int i = 0; i < 4; i++)
        memory[i] = tensors[i]->data = new_written(tensor_bytes(tensors[i]));
    memory[4] = step->forward_space = new_written(step->forward_scratch);
    memory[5] = step->backward_space = new_written(step->backward_scratch);
    for (int i = 0; i < 6; i++)
        if (!memory[i]) return fail(MERLIN_NO_MEMORY, "no memory to measure the peak rate");
    return OK;
}

static status measure(nn_step *step, nn_peak *out)
{
    void *memory[6] = {0};
    status s = conv_create(step);
    if (s == OK) s = allocate_tensors(step, memory);
    if (s == OK) s = step->run->bind(step);
    if (s == OK) s = step->run->refresh(step);
    if (s == OK) s = best_rate(step, step->run->forward, step->forward_flops, &out->forward);
    if (s == OK) s = best_rate(step, conv_backward_data, step->forward_flops, &out->backward_data);
    if (s == OK) s = best_rate(step, conv_backward_weights, step->forward_flops, &out->backward_weights);
    if (step->run) step->run->release(step);
    for (int i = 0; i < 6; i++)
        memory_free(memory[i]);
    return s;
}

status cpu_measure_peak(void *context, nn_type type, nn_peak *out)
{
    enum { CHANNELS = 64, SIZE = 128, BATCH = 8, KERNEL = 3 };
    const size_t count = (size_t)CHANNELS * CHANNELS * KERNEL * KERNEL;
    nn_param weight = {.name = "weight",
                       .rank = 4,
                       .shape = {CHANNELS, CHANNELS, KERNEL, KERNEL},
                       .count = count,
                       .value = new_written(count * sizeof(float)),
                       .gradient = new_written(count * sizeof(float))};
    nn_tensor tensor = {.type = type, .n = BATCH, .h = SIZE, .w = SIZE, .c = CHANNELS};
    nn_step step = {.op = OP_CONV,
                    .at = {.kernel = KERNEL, .stride = 1, .dilation = 1},
                    .compute = type,
                    .train = true,
                    .backs = true,
                    .inputs = 1,
                    .in = {tensor},
                    .out = tensor,
                    .in_gradient = {tensor},
                    .out_gradient = tensor,
                    .wants = {true},
                    .params = {.weight = &weight},
                    .context = context};
    status s = weight.value && weight.gradient ? measure(&step, out)
                                               : fail(MERLIN_NO_MEMORY, "no memory to measure the peak rate");
    memory_free(weight.value);
    memory_free(weight.gradient);
    return s;
}
