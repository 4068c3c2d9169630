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

/* Chooses the type. AMX computes many times faster in bfloat16, and AMD's cores do as many bfloat16 products of pairs
 * as float32 products. Intel's cores do a quarter as many: without AMX float32 is twice as fast there
 * (docs/notes/number_type.md). */
nn_type tuning_fastest_type(void)
{
    if (has_isa(dnnl_cpu_isa_avx512_core_amx)) return NN_BFLOAT16;
    return has_isa(dnnl_cpu_isa_avx512_core_bf16) && is_amd() ? NN_BFLOAT16 : NN_FLOAT32;
}

/* ---- filtering ---- */

/* Bounds of the layers that are computed by filtering. It has four times as many weights: with few tiles they cost more
 * to compute and to read than is gained, and without training more to hold. Transforming pictures of few channels costs
 * more than their products, even more so backwards. */
typedef struct filtered {
    size_t least_tiles;
    int least_channels;         /* of the result */
    size_t most_weights_a_tile; /* filtered weights */
} filtered;

enum { NEVER = INT_MAX };

/* Returns the bounds as measured on Zen 4 (docs/notes/filtered_layers.md). Without training, layers of 64 tiles are
 * filtered in float32 up to 160 channels, and those of 256 channels in 512×512 pictures are not: they would hold 40 MB
 * more. */
static filtered filtered_in(nn_type type, bool trained)
{
#if defined(__AVX2__) && defined(__FMA__)
    const bool amx = has_isa(dnnl_cpu_isa_avx512_core_amx); /* computes bfloat16 faster than filtering can save */
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
