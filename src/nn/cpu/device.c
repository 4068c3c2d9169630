/* The CPU as a device: oneDNN for convolutions, OpenMP loops for the rest. */
#ifdef __SSE__
#include <xmmintrin.h>
#endif

#include "base/memory.h"
#include "nn/cpu/dnn.h"
#include "nn/cpu/kernels.h"
#include "nn/cpu/steps.h"

static bool has_isa(dnnl_cpu_isa_t wanted)
{
    unsigned isa = (unsigned)dnnl_get_effective_cpu_isa();
    return (isa & (unsigned)wanted) == (unsigned)wanted;
}

static nn_type usable_type(nn_type wanted)
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
 * one. Intel's cores do it a quarter as often: where AMX is missing or hidden, float32 is twice as fast. */
static nn_type fastest_type(void)
{
    if (has_isa(dnnl_cpu_isa_avx512_core_amx)) return NN_BFLOAT16;
    return has_isa(dnnl_cpu_isa_avx512_core_bf16) && is_amd() ? NN_BFLOAT16 : NN_FLOAT32;
}

/* Tells whether Winograd's filtering is faster than oneDNN's sums where it suits a convolution at all. In float32 a
 * training step takes 0.6 of the time by registers of sixteen floats, in bfloat16 0.8 (Zen 5, docs/evaluation.md); AMX
 * does bfloat16 products faster than the filtering's own. */
static bool filtering_pays(nn_type type)
{
#if defined(__AVX2__) && defined(__FMA__)
    return type == NN_FLOAT32 || !has_isa(dnnl_cpu_isa_avx512_core_amx);
#else
    (void)type;
    return false;
#endif
}

static status create(nn_step *step)
{
    if (op_is_conv(step->op))
        return filtering_pays(step->compute) && winograd_suits(step) ? winograd_create(step) : conv_create(step);
    if (step->op == OP_NORM) return norm_create(step);
    return kernel_create(step);
}

/* Denormal numbers cost a hundred times their worth: every compute thread takes them for zero during a run. */
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
    /* all threads, not this one alone: what others compute between runs must not depend on which thread does it */
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
        .usable_type = usable_type,
        .fastest_type = fastest_type,
        .open = dnn_open,
        .close = dnn_close,
        .create = create,
        .allocate = memory_new,
        .release = memory_free,
        .begin = begin,
        .end = end,
        .convert = convert,
        .measure_peak = cpu_measure_peak,
    };
    return &device;
}
