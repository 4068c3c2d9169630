/* SPDX-License-Identifier: MIT */
#include "nn/cpu/tuning.h"

#include <limits.h>
#include <stdint.h>

#include "nn/cpu/dnn/dnn.h"
#include "nn/cpu/kernels/steps.h"
#include "nn/cpu/winograd/winograd.h"

static bool has_isa(dnnl_cpu_isa_t wanted)
{
    unsigned isa = (unsigned)dnnl_get_effective_cpu_isa();
    return (isa & (unsigned)wanted) == (unsigned)wanted;
}

nn_type tuning_usable_type(nn_type wanted)
{
    return has_isa(dnnl_cpu_isa_avx512_core) ? wanted : NN_FLOAT32;
}

#if defined(__x86_64__) || defined(__i386__)
static bool is_amd(void)
{
    __builtin_cpu_init();
    return __builtin_cpu_is("amd");
}
#else
static bool is_amd(void)
{
    return false;
}
#endif

/* AMX computes in bfloat16 many times as fast, and AMD's cores do a bfloat16 product of pairs as often as a float32
 * one. Intel's cores do it a quarter as often: where AMX is missing or hidden, float32 is twice as fast
 * (docs/notes/number_type.md). */
nn_type tuning_fastest_type(void)
{
    if (has_isa(dnnl_cpu_isa_avx512_core_amx)) return NN_BFLOAT16;
    return has_isa(dnnl_cpu_isa_avx512_core_bf16) && is_amd() ? NN_BFLOAT16 : NN_FLOAT32;
}

/* ---- filtering ---- */

/* Bounds of the layers that are filtered. Weights are then four times as many: with few tiles they cost more to make
 * and to read than is gained, and where nothing is trained more to hold. Passing over pictures of few channels costs
 * more than their products, the more so backwards. */
typedef struct filtered {
    size_t least_tiles;
    int least_channels;         /* the result's */
    size_t most_weights_a_tile; /* filtered ones */
} filtered;

enum { NEVER = INT_MAX };

/* Measured on Zen 4 (docs/notes/filtered_layers.md). Where nothing is trained, layers of 64 tiles are filtered in
 * float32 up to 160 channels, and not those of 256 that 512×512 pictures have: these would hold 40 MB more. */
static filtered filtered_in(nn_type type, bool trained)
{
#if defined(__AVX2__) && defined(__FMA__)
    const bool amx = has_isa(dnnl_cpu_isa_avx512_core_amx); /* computes bfloat16 faster than filtering spares */
    if (type == NN_FLOAT32) return trained ? (filtered){48, 0, SIZE_MAX} : (filtered){64, 0, 12000};
    if (!amx) return trained ? (filtered){48, 48, SIZE_MAX} : (filtered){128, 0, SIZE_MAX};
#endif
    (void)type;
    (void)trained;
    return (filtered){0, NEVER, SIZE_MAX};
}

bool tuning_filters(const nn_step *step)
{
    if (step->filtering == NN_FILTER_NONE || !winograd_suits(step)) return false;
    if (step->filtering == NN_FILTER_ALL) return true;
    const nn_tensor *x = &step->in[0];
    const winograd shape = {.n = x->n, .h = x->h, .w = x->w};
    const filtered pays = filtered_in(step->compute, step->backs);
    const size_t tiles = winograd_tiles(&shape), weights = winograd_weights(x->c, step->out.c);
    return tiles >= pays.least_tiles && step->out.c >= pays.least_channels &&
           weights / tiles <= pays.most_weights_a_tile;
}
