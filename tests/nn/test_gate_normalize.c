/* SPDX-License-Identifier: MIT */
#include "tensors.h"

static const int bases[][4] = {{1, 1, 1, 1}, {2, 5, 7, 3}, {1, 3, 2, 1500}, {2, 19, 23, 33}};
enum { BASES = sizeof bases / sizeof *bases };

static cpu_tensor made(nn_type type, const int *b, int channels, uint64_t seed)
{
    return tensor_random(type, b[0], b[1], b[2], channels, seed);
}

static void gate_scales_every_channel_of_a_pixel(void **state)
{
    (void)state;
    for (int b = 0; b < BASES; b++)
        for (int t = NN_FLOAT32; t <= NN_BFLOAT16; t++) {
            size_t channels = (size_t)bases[b][3];
            cpu_tensor x = made((nn_type)t, bases[b], bases[b][3], 1), gate = made((nn_type)t, bases[b], 1, 2);
            cpu_tensor y = tensor_like(&x), expected = tensor_converted(&x, NN_FLOAT32);
            for (size_t i = 0; i < cpu_count(&x); i++)
                tensor_set(&expected, i, tensor_get(&x, i) * tensor_get(&gate, i / channels));
            cpu_gate(&x, &gate, &y);
            assert_near("gate", &y, &expected, tensor_rounding((nn_type)t), 0);
            tensor_free(&x), tensor_free(&gate), tensor_free(&y), tensor_free(&expected);
        }
}

static void check_gate_backward(const int *b, nn_type type, bool accumulate)
{
    size_t channels = (size_t)b[3];
    cpu_tensor x = made(type, b, b[3], 1), gate = made(type, b, 1, 2), dy = made(type, b, b[3], 3);
    cpu_tensor dx = made(type, b, b[3], 4), dgate = made(type, b, 1, 5);
    cpu_tensor want_x = tensor_converted(&dx, NN_FLOAT32), want_gate = tensor_converted(&dgate, NN_FLOAT32);
    for (size_t p = 0; p < cpu_count(&gate); p++) {
        double sum = accumulate ? tensor_get(&dgate, p) : 0;
        for (size_t i = p * channels; i < (p + 1) * channels; i++) {
            double before = accumulate ? tensor_get(&dx, i) : 0;
            tensor_set(&want_x, i, before + tensor_get(&dy, i) * tensor_get(&gate, p));
            sum += tensor_get(&dy, i) * tensor_get(&x, i);
        }
        tensor_set(&want_gate, p, sum);
    }
    cpu_gate_backward(&x, &gate, &dy, &dx, accumulate, &dgate, accumulate);
    assert_near("dx", &dx, &want_x, tensor_rounding(type), 1e-6);
    /* a float sum over the channels of products below 1 */
    assert_near("dgate", &dgate, &want_gate, tensor_rounding(type), 1e-7 * (double)channels + 1e-6);
    tensor_free(&x), tensor_free(&gate), tensor_free(&dy), tensor_free(&dx), tensor_free(&dgate);
    tensor_free(&want_x), tensor_free(&want_gate);
}

static void gate_backward_is_the_product_rule(void **state)
{
    (void)state;
    for (int b = 0; b < BASES; b++)
        for (int accumulate = 0; accumulate < 2; accumulate++) {
            check_gate_backward(bases[b], NN_FLOAT32, accumulate);
            check_gate_backward(bases[b], NN_BFLOAT16, accumulate);
        }
}

/* In x·x both gradients are of the same tensor, the first written and the second added. */
static void what_is_gated_by_itself_has_twice_the_gradient(void **state)
{
    (void)state;
    for (int t = NN_FLOAT32; t <= NN_BFLOAT16; t++) {
        const int *b = bases[3];
        cpu_tensor x = made((nn_type)t, b, 1, 1), dy = made((nn_type)t, b, 1, 2), dx = made((nn_type)t, b, 1, 3);
        cpu_tensor expected = tensor_converted(&x, NN_FLOAT32);
        for (size_t i = 0; i < cpu_count(&x); i++)
            tensor_set(&expected, i, 2 * tensor_get(&x, i) * tensor_get(&dy, i));
        cpu_gate_backward(&x, &x, &dy, &dx, false, &dx, true);
        /* rounded when written and again when added */
        assert_near("dx", &dx, &expected, 2 * tensor_rounding((nn_type)t), 0);
        tensor_free(&x), tensor_free(&dy), tensor_free(&dx), tensor_free(&expected);
    }
}

static void gate_leaves_out_unwanted_gradients(void **state)
{
    (void)state;
    const int *b = bases[1];
    cpu_tensor x = made(NN_FLOAT32, b, b[3], 1), gate = made(NN_FLOAT32, b, 1, 2), dx[2], dgate[2];
    for (int i = 0; i < 2; i++)
        dx[i] = tensor_like(&x), dgate[i] = tensor_like(&gate);
    cpu_gate_backward(&x, &gate, &x, &dx[0], false, &dgate[0], false);
    cpu_gate_backward(&x, &gate, &x, &dx[1], false, NULL, false);
    cpu_gate_backward(&x, &gate, &x, NULL, false, &dgate[1], false);
    assert_same_bits("dx alone", &dx[0], &dx[1]);
    assert_same_bits("dgate alone", &dgate[0], &dgate[1]);
    for (int i = 0; i < 2; i++)
        tensor_free(&dx[i]), tensor_free(&dgate[i]);
    tensor_free(&x), tensor_free(&gate);
}

static double length_of(const cpu_tensor *t, size_t pixel)
{
    double sum = 0;
    for (size_t c = 0; c < (size_t)t->c; c++)
        sum += pow(tensor_get(t, pixel * (size_t)t->c + c), 2);
    return sqrt(sum);
}

static void normalized_vectors_are_unit_and_keep_their_direction(void **state)
{
    (void)state;
    for (int b = 0; b < BASES; b++) {
        cpu_tensor x = made(NN_FLOAT32, bases[b], bases[b][3], 1), y = tensor_like(&x), expected = tensor_like(&x);
        for (size_t i = 0; i < cpu_count(&x); i++)
            tensor_set(&expected, i, tensor_get(&x, i) / length_of(&x, i / (size_t)x.c));
        cpu_normalize(&x, &y);
        assert_near("normalize", &y, &expected, 1e-5, 0); /* a float sum of up to 1500 squares */
        tensor_free(&x), tensor_free(&y), tensor_free(&expected);
    }
}

/* Returns Σ dy·x/|x| at one pixel with component c changed by h. */
static double moved(const cpu_tensor *x, const cpu_tensor *dy, size_t pixel, size_t c, double h)
{
    size_t channels = (size_t)x->c, first = pixel * channels;
    double sum = 0, square = 0;
    for (size_t i = 0; i < channels; i++) {
        double v = tensor_get(x, first + i) + (i == c ? h : 0);
        square += v * v;
        sum += v * tensor_get(dy, first + i);
    }
    return sum / sqrt(square);
}

static void normalize_backward_is_that_of_central_differences(void **state)
{
    (void)state;
    const int *b = bases[1];
    for (int accumulate = 0; accumulate < 2; accumulate++) {
        cpu_tensor x = made(NN_FLOAT32, b, b[3], 1), y = tensor_like(&x);
        cpu_tensor dy = made(NN_FLOAT32, b, b[3], 2), dx = made(NN_FLOAT32, b, b[3], 3);
        cpu_tensor expected = tensor_like(&x);
        for (size_t i = 0; i < cpu_count(&x); i++) {
            size_t pixel = i / (size_t)x.c, c = i % (size_t)x.c;
            double slope = (moved(&x, &dy, pixel, c, 1e-5) - moved(&x, &dy, pixel, c, -1e-5)) / 2e-5;
            tensor_set(&expected, i, slope + (accumulate ? tensor_get(&dx, i) : 0));
        }
        cpu_normalize(&x, &y);
        cpu_normalize_backward(&x, &y, &dy, &dx, accumulate);
        /* float cancellation in dy - y (y·dy), divided by lengths down to 0.1 */
        assert_near("normalize", &dx, &expected, 1e-5, 1e-5);
        tensor_free(&x), tensor_free(&y), tensor_free(&dy), tensor_free(&dx), tensor_free(&expected);
    }
}

static void vectors_without_direction_stay_finite(void **state)
{
    (void)state;
    float zero[6] = {0, 0, 0, 1e-20f, -1e-20f, 0}, unit[6], ones[6] = {1, 1, 1, 1, 1, 1}, gradient[6];
    cpu_tensor x = {zero, NN_FLOAT32, 1, 1, 2, 3}, y = x, dy = x, dx = x;
    y.data = unit, dy.data = ones, dx.data = gradient;
    cpu_normalize(&x, &y);
    cpu_normalize_backward(&x, &y, &dy, &dx, false);
    for (int i = 0; i < 6; i++)
        assert_true(fabsf(unit[i]) < 1e-10f && gradient[i] == 0);
}

static void results_do_not_depend_on_the_number_of_threads(void **state)
{
    (void)state;
    const int *b = bases[3];
    int before = parallel_threads();
    cpu_tensor x = made(NN_FLOAT32, b, b[3], 1), gate = made(NN_FLOAT32, b, 1, 2), y[2], dx[2], dgate[2], unit[2];
    for (int i = 0; i < 2; i++) {
        y[i] = tensor_like(&x), dx[i] = tensor_like(&x), unit[i] = tensor_like(&x), dgate[i] = tensor_like(&gate);
        threads_use_here(i + 1);
        cpu_gate(&x, &gate, &y[i]);
        cpu_gate_backward(&x, &gate, &y[i], &dx[i], false, &dgate[i], false);
        cpu_normalize(&x, &unit[i]);
        cpu_normalize_backward(&x, &unit[i], &y[i], &dx[i], true);
    }
    threads_use_here(before);
    assert_same_bits("gate", &y[0], &y[1]), assert_same_bits("dgate", &dgate[0], &dgate[1]);
    assert_same_bits("dx", &dx[0], &dx[1]), assert_same_bits("normalize", &unit[0], &unit[1]);
    for (int i = 0; i < 2; i++)
        tensor_free(&y[i]), tensor_free(&dx[i]), tensor_free(&dgate[i]), tensor_free(&unit[i]);
    tensor_free(&x), tensor_free(&gate);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(gate_scales_every_channel_of_a_pixel),
        cmocka_unit_test(gate_backward_is_the_product_rule),
        cmocka_unit_test(what_is_gated_by_itself_has_twice_the_gradient),
        cmocka_unit_test(gate_leaves_out_unwanted_gradients),
        cmocka_unit_test(normalized_vectors_are_unit_and_keep_their_direction),
        cmocka_unit_test(normalize_backward_is_that_of_central_differences),
        cmocka_unit_test(vectors_without_direction_stay_finite),
        cmocka_unit_test(results_do_not_depend_on_the_number_of_threads),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
