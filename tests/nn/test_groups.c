/* SPDX-License-Identifier: MIT */
/* Kernels over an object's pictures, and layer norm: values against plain references in double, gradients
 * against finite differences of those, in both number types, and bit for bit over numbers of threads. */
#include "nn/cpu/kernels/chunk.h"
#include "nn/cpu/kernels/group.h"
#include "nn/cpu/kernels/layer_norm.h"
#include "tensors.h"

enum { HEADS = 2 };

/* Sizes: objects, pictures of each, height, width, channels of an object's result. */
typedef struct shape {
    int objects, pictures, h, w, c;
} shape;

static const shape small[] = {{1, 1, 1, 1, 4}, {2, 3, 2, 2, 4}, {1, 5, 1, 3, 6}, {3, 2, 1, 1, 8}};
static const shape large[] = {{2, 6, 19, 23, 36}, {1, 64, 5, 4, 128}};
enum { SMALL = sizeof small / sizeof *small, LARGE = sizeof large / sizeof *large };

/* An operation under test. */
typedef struct operation {
    const char *name;
    int parts;         /* channels of the input in those of the result */
    bool of_objects;   /* the result has an image for each object; otherwise for each picture */
    bool from_objects; /* so has the input */
    void (*forward)(const shape *s, const cpu_tensor *x, const cpu_tensor *present, cpu_tensor *y);
    void (*backward)(const shape *s, const cpu_tensor *x, const cpu_tensor *present, const cpu_tensor *y,
                     const cpu_tensor *dy, cpu_tensor *dx, bool accumulate);
    /* Computes an object's values at a pixel: x has a row of parts·c numbers a picture, y one of c, or of one a
     * picture. */
    void (*reference)(const shape *s, const double *x, const bool *present, double *y);
} operation;

/* Numbers that the parameters have in all tests. */
static float query[256], weight[256], bias[256];

static void fill_params(void)
{
    rng r = rng_at(5, 0, 0);
    for (int i = 0; i < 256; i++) {
        query[i] = 2 * rng_range(&r, -1, 1);
        weight[i] = rng_range(&r, 0.5f, 1.5f);
        bias[i] = rng_range(&r, -1, 1);
    }
}

/* ---- the operations ---- */

static void max_forward(const shape *s, const cpu_tensor *x, const cpu_tensor *present, cpu_tensor *y)
{
    (void)s;
    cpu_group_max(x, present, y);
}

static void max_backward(const shape *s, const cpu_tensor *x, const cpu_tensor *present, const cpu_tensor *y,
                         const cpu_tensor *dy, cpu_tensor *dx, bool accumulate)
{
    (void)s;
    cpu_group_max_backward(x, present, y, dy, dx, accumulate);
}

static void max_reference(const shape *s, const double *x, const bool *present, double *y)
{
    for (int c = 0; c < s->c; c++) {
        double largest = -INFINITY;
        for (int k = 0; k < s->pictures; k++)
            if (present[k]) largest = fmax(largest, x[k * s->c + c]);
        y[c] = isinf(largest) ? 0 : largest;
    }
}

static void mean_forward(const shape *s, const cpu_tensor *x, const cpu_tensor *present, cpu_tensor *y)
{
    (void)s;
    cpu_group_mean(x, present, y);
}

static void mean_backward(const shape *s, const cpu_tensor *x, const cpu_tensor *present, const cpu_tensor *y,
                          const cpu_tensor *dy, cpu_tensor *dx, bool accumulate)
{
    (void)s, (void)x, (void)y;
    cpu_group_mean_backward(present, dy, dx, accumulate);
}

static void mean_reference(const shape *s, const double *x, const bool *present, double *y)
{
    for (int c = 0; c < s->c; c++) {
        double sum = 0, count = 0;
        for (int k = 0; k < s->pictures; k++)
            if (present[k]) sum += x[k * s->c + c], count++;
        y[c] = count > 0 ? sum / count : 0;
    }
}

static void spread_forward(const shape *s, const cpu_tensor *x, const cpu_tensor *present, cpu_tensor *y)
{
    (void)s;
    cpu_group_spread(x, present, y);
}

static void spread_backward(const shape *s, const cpu_tensor *x, const cpu_tensor *present, const cpu_tensor *y,
                            const cpu_tensor *dy, cpu_tensor *dx, bool accumulate)
{
    (void)s, (void)y;
    cpu_group_spread_backward(x, present, dy, dx, accumulate);
}

static void spread_reference(const shape *s, const double *x, const bool *present, double *y)
{
    double mean[256];
    mean_reference(s, x, present, mean);
    for (int c = 0; c < s->c; c++) {
        double sum = 0, count = 0;
        for (int k = 0; k < s->pictures; k++)
            if (present[k]) sum += pow(x[k * s->c + c] - mean[c], 2), count++;
        y[c] = count > 0 ? sqrt(sum / count + 1e-8) : 0;
    }
}

static void repeat_forward(const shape *s, const cpu_tensor *x, const cpu_tensor *present, cpu_tensor *y)
{
    (void)s, (void)present;
    cpu_group_repeat(x, y);
}

static void repeat_backward(const shape *s, const cpu_tensor *x, const cpu_tensor *present, const cpu_tensor *y,
                            const cpu_tensor *dy, cpu_tensor *dx, bool accumulate)
{
    (void)s, (void)present, (void)x, (void)y;
    cpu_group_repeat_backward(dy, dx, accumulate);
}

static void repeat_reference(const shape *s, const double *x, const bool *present, double *y)
{
    (void)present;
    for (int i = 0; i < s->pictures * s->c; i++)
        y[i] = x[i % s->c];
}

static void attention_forward(const shape *s, const cpu_tensor *x, const cpu_tensor *present, cpu_tensor *y)
{
    cpu_group_attention(x, &(cpu_heads){HEADS, s->pictures, present}, y);
}

static void attention_backward(const shape *s, const cpu_tensor *x, const cpu_tensor *present, const cpu_tensor *y,
                               const cpu_tensor *dy, cpu_tensor *dx, bool accumulate)
{
    (void)y;
    cpu_group_attention_backward(x, &(cpu_heads){HEADS, s->pictures, present}, dy, dx, accumulate);
}

/* Computes softmax(q·k/√width)·v of one head; q: its query; keys and values a row of `stride` numbers a picture. */
static void attend(const shape *s, const double *q, const double *keys, const double *values, int stride,
                   const bool *present, double *y)
{
    const int width = s->c / HEADS;
    double sum = 0;
    for (int i = 0; i < width; i++)
        y[i] = 0;
    for (int k = 0; k < s->pictures; k++) {
        double score = 0;
        for (int i = 0; i < width; i++)
            score += q[i] * keys[k * stride + i];
        const double share = present[k] ? exp(score / sqrt(width)) : 0;
        sum += share;
        for (int i = 0; i < width; i++)
            y[i] += share * values[k * stride + i];
    }
    for (int i = 0; i < width && sum > 0; i++)
        y[i] /= sum;
}

static void attention_reference(const shape *s, const double *x, const bool *present, double *y)
{
    for (int k = 0; k < s->pictures; k++)
        for (int h = 0; h < s->c; h += s->c / HEADS) {
            const double *q = x + 3 * s->c * k + h;
            attend(s, q, x + s->c + h, x + 2 * s->c + h, 3 * s->c, present, y + s->c * k + h);
            for (int i = 0; i < s->c / HEADS && !present[k]; i++)
                y[s->c * k + h + i] = 0;
        }
}

static void pool_forward(const shape *s, const cpu_tensor *x, const cpu_tensor *present, cpu_tensor *y)
{
    cpu_group_pool(x, &(cpu_heads){HEADS, s->pictures, present}, query, y);
}

static void pool_backward(const shape *s, const cpu_tensor *x, const cpu_tensor *present, const cpu_tensor *y,
                          const cpu_tensor *dy, cpu_tensor *dx, bool accumulate)
{
    (void)y;
    float *partial = malloc(sizeof *partial * CPU_PARTS * (size_t)s->c), dquery[256];
    cpu_group_pool_backward(x, &(cpu_heads){HEADS, s->pictures, present}, query, dy, dx, accumulate, partial, dquery);
    free(partial);
}

static void pool_reference(const shape *s, const double *x, const bool *present, double *y)
{
    double q[256];
    for (int i = 0; i < s->c; i++)
        q[i] = (double)query[i];
    for (int h = 0; h < s->c; h += s->c / HEADS)
        attend(s, q + h, x + h, x + s->c + h, 2 * s->c, present, y + h);
}

static void layer_norm_forward_of(const shape *s, const cpu_tensor *x, const cpu_tensor *present, cpu_tensor *y)
{
    (void)s, (void)present;
    cpu_layer_norm(x, (layer_norm_params){weight, bias}, y);
}

static void layer_norm_backward_of(const shape *s, const cpu_tensor *x, const cpu_tensor *present, const cpu_tensor *y,
                                   const cpu_tensor *dy, cpu_tensor *dx, bool accumulate)
{
    (void)present, (void)y;
    float *partial = malloc(sizeof *partial * layer_norm_partial_floats(s->c)), dweight[256], dbias[256];
    cpu_layer_norm_backward(x, (layer_norm_params){weight, bias}, dy, dx, accumulate, partial,
                            (layer_norm_params){dweight, dbias});
    free(partial);
}

static void layer_norm_reference(const shape *s, const double *x, const bool *present, double *y)
{
    (void)present;
    for (int k = 0; k < s->pictures; k++, x += s->c, y += s->c) {
        double mean = 0, variance = 0;
        for (int c = 0; c < s->c; c++)
            mean += x[c] / s->c;
        for (int c = 0; c < s->c; c++)
            variance += pow(x[c] - mean, 2) / s->c;
        for (int c = 0; c < s->c; c++)
            y[c] = (double)weight[c] * (x[c] - mean) / sqrt(variance + 1e-5) + (double)bias[c];
    }
}

static const operation operations[] = {
    {"max", 1, true, false, max_forward, max_backward, max_reference},
    {"mean", 1, true, false, mean_forward, mean_backward, mean_reference},
    {"spread", 1, true, false, spread_forward, spread_backward, spread_reference},
    {"repeat", 1, false, true, repeat_forward, repeat_backward, repeat_reference},
    {"attention", 3, false, false, attention_forward, attention_backward, attention_reference},
    {"pool", 2, true, false, pool_forward, pool_backward, pool_reference},
    {"layer norm", 1, false, false, layer_norm_forward_of, layer_norm_backward_of, layer_norm_reference},
};
enum { OPERATIONS = sizeof operations / sizeof *operations };

/* ---- all pixels ---- */

static int images(const shape *s, bool of_objects)
{
    return of_objects ? s->objects : s->objects * s->pictures;
}

/* Makes a number for each picture; of every object but the first, one picture or two are left out. */
static cpu_tensor presence(const shape *s)
{
    cpu_tensor t = tensor_new(NN_FLOAT32, s->objects * s->pictures, 1, 1, 1);
    for (int i = 0; i < t.n; i++) {
        const int object = i / s->pictures, picture = i % s->pictures;
        tensor_set(&t, (size_t)i, object > 0 && picture % 3 == object % 3 ? 0 : 0.5);
    }
    return t;
}

/* Copies rows of one pixel of an object between a tensor and numbers. */
static void take_rows(const cpu_tensor *t, const shape *s, bool of_objects, int object, size_t pixel, double *rows)
{
    const int count = of_objects ? 1 : s->pictures;
    for (int k = 0; k < count; k++)
        for (int c = 0; c < t->c; c++)
            *rows++ = tensor_get(t, ((size_t)(object * count + k) * (size_t)(s->h * s->w) + pixel) * (size_t)t->c +
                                        (size_t)c);
}

static void put_rows(cpu_tensor *t, const shape *s, bool of_objects, int object, size_t pixel, const double *rows)
{
    const int count = of_objects ? 1 : s->pictures;
    for (int k = 0; k < count; k++)
        for (int c = 0; c < t->c; c++)
            tensor_set(t, ((size_t)(object * count + k) * (size_t)(s->h * s->w) + pixel) * (size_t)t->c + (size_t)c,
                       *rows++);
}

enum { ROWS = 64 * 3 * 128 };

/* Computes what an operation should give. */
static cpu_tensor expected_of(const operation *o, const shape *s, const cpu_tensor *x, const cpu_tensor *present)
{
    static double in[ROWS], out[ROWS];
    cpu_tensor y = tensor_new(NN_FLOAT32, images(s, o->of_objects), s->h, s->w, s->c);
    for (int object = 0; object < s->objects; object++)
        for (size_t pixel = 0; pixel < (size_t)(s->h * s->w); pixel++) {
            bool there[64];
            for (int k = 0; k < s->pictures; k++)
                there[k] = !present || tensor_get(present, (size_t)(object * s->pictures + k)) > 0;
            take_rows(x, s, o->from_objects, object, pixel, in);
            o->reference(s, in, there, out);
            put_rows(&y, s, o->of_objects, object, pixel, out);
        }
    return y;
}

static cpu_tensor input_of(const operation *o, const shape *s, nn_type type, uint64_t seed)
{
    return tensor_random(type, images(s, o->from_objects), s->h, s->w, o->parts * s->c, seed);
}

static void check_forward(const operation *o, const shape *s, nn_type type, bool some)
{
    cpu_tensor x = input_of(o, s, type, 1), present = presence(s);
    cpu_tensor y = tensor_new(type, images(s, o->of_objects), s->h, s->w, s->c);
    tensor_fill(&y, 2, 5, 6); /* all of it is written */
    cpu_tensor expected = expected_of(o, s, &x, some ? &present : NULL);
    o->forward(s, &x, some ? &present : NULL, &y);
    /* sums of up to 64 floats; the spread of numbers that agree is a difference of roundings */
    assert_near(o->name, &y, &expected, tensor_rounding(type) + 3e-6, 3e-6);
    tensor_free(&x), tensor_free(&present), tensor_free(&y), tensor_free(&expected);
}

static void results_are_those_of_a_plain_loop(void **state)
{
    (void)state;
    for (int i = 0; i < OPERATIONS; i++)
        for (int t = NN_FLOAT32; t <= NN_BFLOAT16; t++)
            for (int some = 0; some < 2; some++) {
                for (int k = 0; k < SMALL; k++)
                    check_forward(&operations[i], &small[k], (nn_type)t, some);
                for (int k = 0; k < LARGE; k++)
                    check_forward(&operations[i], &large[k], (nn_type)t, some);
            }
}

/* ---- gradients ---- */

/* Computes Σ dy·y by the reference at one pixel. */
static double product_at(const operation *o, const shape *s, const double *in, const bool *there, const double *d)
{
    double out[ROWS / 64], sum = 0;
    o->reference(s, in, there, out);
    for (int i = 0; i < (o->of_objects ? 1 : s->pictures) * s->c; i++)
        sum += out[i] * d[i];
    return sum;
}

/* Computes the gradient of x by central differences of the reference. */
static void slopes_at(const operation *o, const shape *s, double *in, const bool *there, const double *d, double *slope)
{
    const double step = 1e-5;
    for (int i = 0; i < (o->from_objects ? 1 : s->pictures) * o->parts * s->c; i++) {
        const double kept = in[i];
        in[i] = kept + step;
        slope[i] = product_at(o, s, in, there, d);
        in[i] = kept - step;
        slope[i] = (slope[i] - product_at(o, s, in, there, d)) / (2 * step);
        in[i] = kept;
    }
}

static void check_backward(const operation *o, const shape *s, nn_type type, bool some, bool accumulate)
{
    cpu_tensor x = input_of(o, s, type, 1), present = presence(s);
    cpu_tensor y = tensor_new(type, images(s, o->of_objects), s->h, s->w, s->c), dy = tensor_like(&y);
    cpu_tensor dx = tensor_like(&x), expected = tensor_converted(&x, NN_FLOAT32);
    const cpu_tensor *there = some ? &present : NULL;
    tensor_fill(&dy, 3, -1, 1), tensor_fill(&dx, 4, -1, 1);
    double in[ROWS / 64], d[ROWS / 64], slope[ROWS / 64], before[ROWS / 64];
    for (int object = 0; object < s->objects; object++)
        for (size_t pixel = 0; pixel < (size_t)(s->h * s->w); pixel++) {
            bool is_there[64];
            for (int k = 0; k < s->pictures; k++)
                is_there[k] = !some || tensor_get(&present, (size_t)(object * s->pictures + k)) > 0;
            take_rows(&x, s, o->from_objects, object, pixel, in);
            take_rows(&dy, s, o->of_objects, object, pixel, d);
            take_rows(&dx, s, o->from_objects, object, pixel, before);
            slopes_at(o, s, in, is_there, d, slope);
            for (int i = 0; i < ROWS / 64 && accumulate; i++)
                slope[i] += before[i];
            put_rows(&expected, s, o->from_objects, object, pixel, slope);
        }
    o->forward(s, &x, there, &y);
    o->backward(s, &x, there, &y, &dy, &dx, accumulate);
    assert_near(o->name, &dx, &expected, tensor_rounding(type) + 2e-5, 2e-5);
    tensor_free(&x), tensor_free(&present), tensor_free(&y), tensor_free(&dy), tensor_free(&dx), tensor_free(&expected);
}

static void gradients_are_the_slopes_of_a_plain_loop(void **state)
{
    (void)state;
    for (int i = 0; i < OPERATIONS; i++)
        for (int k = 0; k < SMALL; k++)
            for (int some = 0; some < 2; some++)
                for (int accumulate = 0; accumulate < 2; accumulate++) {
                    check_backward(&operations[i], &small[k], NN_FLOAT32, some, accumulate);
                    check_backward(&operations[i], &small[k], NN_BFLOAT16, some, accumulate);
                }
}

static void of_equal_pictures_the_first_receives_the_gradient(void **state)
{
    (void)state;
    cpu_tensor x = tensor_new(NN_FLOAT32, 3, 1, 1, 2), y = tensor_new(NN_FLOAT32, 1, 1, 1, 2), dy = tensor_like(&y);
    cpu_tensor dx = tensor_like(&x), expected = tensor_like(&x);
    tensor_set(&x, 0, 1), tensor_set(&x, 2, 2), tensor_set(&x, 4, 2);
    tensor_set(&dy, 0, 3), tensor_set(&dy, 1, 5);
    tensor_set(&expected, 2, 3), tensor_set(&expected, 1, 5);
    cpu_group_max(&x, NULL, &y);
    cpu_group_max_backward(&x, NULL, &y, &dy, &dx, false);
    assert_near("dx", &dx, &expected, 0, 0);
    tensor_free(&x), tensor_free(&y), tensor_free(&dy), tensor_free(&dx), tensor_free(&expected);
}

/* Returns Σ dy·y after one parameter was changed. */
static double product_with(const operation *o, const shape *s, const cpu_tensor *x, const cpu_tensor *dy, float *param,
                           float value)
{
    const float kept = *param;
    *param = value;
    cpu_tensor y = expected_of(o, s, x, NULL);
    *param = kept;
    const double product = tensor_dot(&y, dy);
    tensor_free(&y);
    return product;
}

static void check_param(const operation *o, const shape *s, const cpu_tensor *x, const cpu_tensor *dy, float *param,
                        float found)
{
    const float step = 1e-2f, high = *param + step, low = *param - step;
    const double slope =
        (product_with(o, s, x, dy, param, high) - product_with(o, s, x, dy, param, low)) / ((double)high - (double)low);
    if (fabs(slope - (double)found) > 2e-3 * fabs(slope) + 1e-3) fail_msg("%s: %g, expected %g", o->name, found, slope);
}

static void gradients_of_parameters_are_slopes_too(void **state)
{
    (void)state;
    const shape *s = &small[1];
    const operation *pool = &operations[5], *norm = &operations[6];
    cpu_tensor x = input_of(pool, s, NN_FLOAT32, 1), none = {.type = NN_FLOAT32};
    cpu_tensor dy = tensor_random(NN_FLOAT32, s->objects, s->h, s->w, s->c, 2);
    float partial[2 * CPU_PARTS * 8], dquery[8], dweight[8], dbias[8];
    cpu_group_pool_backward(&x, &(cpu_heads){HEADS, s->pictures, NULL}, query, &dy, &none, false, partial, dquery);
    for (int i = 0; i < s->c; i++)
        check_param(pool, s, &x, &dy, &query[i], dquery[i]);
    tensor_free(&x), tensor_free(&dy);
    x = input_of(norm, s, NN_FLOAT32, 1);
    dy = tensor_random(NN_FLOAT32, s->objects * s->pictures, s->h, s->w, s->c, 2);
    cpu_layer_norm_backward(&x, (layer_norm_params){weight, bias}, &dy, &none, false, partial,
                            (layer_norm_params){dweight, dbias});
    for (int i = 0; i < s->c; i++) {
        check_param(norm, s, &x, &dy, &weight[i], dweight[i]);
        check_param(norm, s, &x, &dy, &bias[i], dbias[i]);
    }
    tensor_free(&x), tensor_free(&dy);
}

/* ---- threads ---- */

static void results_do_not_depend_on_the_number_of_threads(void **state)
{
    (void)state;
    const int before = parallel_threads();
    const shape *s = &large[0];
    for (int i = 0; i < OPERATIONS; i++) {
        const operation *o = &operations[i];
        cpu_tensor x = input_of(o, s, NN_FLOAT32, 1), present = presence(s), y[2], dx[2];
        for (int k = 0; k < 2; k++) {
            threads_use_here(k ? 3 : 1);
            y[k] = tensor_new(NN_FLOAT32, images(s, o->of_objects), s->h, s->w, s->c);
            dx[k] = tensor_like(&x);
            o->forward(s, &x, &present, &y[k]);
            o->backward(s, &x, &present, &y[k], &y[k], &dx[k], false);
        }
        assert_same_bits(o->name, &y[0], &y[1]);
        assert_same_bits(o->name, &dx[0], &dx[1]);
        tensor_free(&x), tensor_free(&present);
        for (int k = 0; k < 2; k++)
            tensor_free(&y[k]), tensor_free(&dx[k]);
    }
    threads_use_here(before);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(results_are_those_of_a_plain_loop),
        cmocka_unit_test(gradients_are_the_slopes_of_a_plain_loop),
        cmocka_unit_test(of_equal_pictures_the_first_receives_the_gradient),
        cmocka_unit_test(gradients_of_parameters_are_slopes_too),
        cmocka_unit_test(results_do_not_depend_on_the_number_of_threads),
    };
    fill_params();
    return cmocka_run_group_tests(tests, NULL, NULL);
}
