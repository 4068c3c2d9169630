/* SPDX-License-Identifier: MIT */
#include "nn/cpu/kernels/fast_math.h"

#include "tensors.h"

typedef struct operation {
    const char *name;
    void (*forward)(const cpu_tensor *x, cpu_tensor *y);
    double (*f)(double x);
    void (*backward)(const cpu_tensor *y, const cpu_tensor *dy, cpu_tensor *dx, bool accumulate);
    double (*slope)(double y); /* f' as a function of f's value */
} operation;

static double relu(double x)
{
    return x > 0 ? x : 0;
}

static double relu_slope(double y)
{
    return y > 0 ? 1 : 0;
}

static double tanh_slope(double y)
{
    return 1 - y * y;
}

static double sigmoid(double x)
{
    return 1 / (1 + exp(-x));
}

static double sigmoid_slope(double y)
{
    return y * (1 - y);
}

static void run_affine(const cpu_tensor *x, cpu_tensor *y)
{
    cpu_scale_shift(x, y, 0.4f, 0.65f);
}

static double affine(double x)
{
    return (double)0.4f * x + (double)0.65f;
}

static void run_affine_backward(const cpu_tensor *y, const cpu_tensor *dy, cpu_tensor *dx, bool accumulate)
{
    (void)y;
    cpu_scale_shift_backward(dy, dx, 0.4f, accumulate);
}

static double affine_slope(double y)
{
    (void)y;
    return (double)0.4f;
}

static void run_reciprocal(const cpu_tensor *x, cpu_tensor *y)
{
    cpu_reciprocal(x, y, 0.4f, 0.65f);
}

static double reciprocal(double x)
{
    return 1 / affine(x);
}

static void run_reciprocal_backward(const cpu_tensor *y, const cpu_tensor *dy, cpu_tensor *dx, bool accumulate)
{
    cpu_reciprocal_backward(y, dy, dx, 0.4f, accumulate);
}

static double reciprocal_slope(double y)
{
    return -(double)0.4f * y * y;
}

static const operation operations[] = {
    {"relu", cpu_relu, relu, cpu_relu_backward, relu_slope},
    {"tanh", cpu_tanh, tanh, cpu_tanh_backward, tanh_slope},
    {"sigmoid", cpu_sigmoid, sigmoid, cpu_sigmoid_backward, sigmoid_slope},
    {"scale_shift", run_affine, affine, run_affine_backward, affine_slope},
    {"reciprocal", run_reciprocal, reciprocal, run_reciprocal_backward, reciprocal_slope},
};
enum { OPERATIONS = sizeof operations / sizeof *operations };

static const nn_type types[] = {NN_FLOAT32, NN_BFLOAT16};

/* Sizes below and above a chunk and the threshold for threads, none a multiple of a vector. */
static const int sizes[][4] = {{1, 1, 1, 1}, {2, 5, 7, 3}, {1, 33, 65, 17}};
enum { SIZES = sizeof sizes / sizeof *sizes };

static cpu_tensor sized(nn_type type, int size, uint64_t seed)
{
    const int *s = sizes[size];
    return tensor_random(type, s[0], s[1], s[2], s[3], seed);
}

static void forward_follows_the_formula(void **state)
{
    (void)state;
    for (int o = 0; o < OPERATIONS; o++)
        for (int t = 0; t < 2; t++)
            for (int s = 0; s < SIZES; s++) {
                cpu_tensor x = sized(types[t], s, 1), y = tensor_like(&x);
                cpu_tensor expected = tensor_converted(&x, NN_FLOAT32);
                for (size_t i = 0; i < cpu_count(&x); i++)
                    tensor_set(&expected, i, operations[o].f(tensor_get(&x, i)));
                operations[o].forward(&x, &y);
                assert_near(operations[o].name, &y, &expected, tensor_rounding(types[t]), 0);
                tensor_free(&x), tensor_free(&y), tensor_free(&expected);
            }
}

/* Central differences of f in double have an error of h²|f'''|/6 < 1e-9 and 1e-16/h. */
static void slopes_are_the_derivatives_of_the_formulas(void **state)
{
    (void)state;
    const double h = 1e-5;
    for (int o = 0; o < OPERATIONS; o++)
        for (double x = -0.975; x < 1; x += 0.05) {
            double numeric = (operations[o].f(x + h) - operations[o].f(x - h)) / (2 * h);
            assert_true(fabs(numeric - operations[o].slope(operations[o].f(x))) < 1e-8);
        }
}

static void backward_is_the_slope_times_the_gradient(void **state)
{
    (void)state;
    for (int o = 0; o < OPERATIONS; o++)
        for (int t = 0; t < 2; t++)
            for (int accumulate = 0; accumulate < 2; accumulate++) {
                cpu_tensor x = sized(types[t], 2, 1), y = tensor_like(&x), dy = sized(types[t], 2, 2);
                cpu_tensor dx = sized(types[t], 2, 3), expected = tensor_converted(&x, NN_FLOAT32);
                operations[o].forward(&x, &y);
                for (size_t i = 0; i < cpu_count(&x); i++)
                    tensor_set(&expected, i,
                               operations[o].slope(tensor_get(&y, i)) * tensor_get(&dy, i) +
                                   (accumulate ? tensor_get(&dx, i) : 0));
                operations[o].backward(&y, &dy, &dx, accumulate);
                /* 1e-6: 1 - y² and sums cancel */
                assert_near(operations[o].name, &dx, &expected, tensor_rounding(types[t]), 1e-6);
                tensor_free(&x), tensor_free(&y), tensor_free(&dy), tensor_free(&dx), tensor_free(&expected);
            }
}

static void results_do_not_depend_on_the_number_of_threads(void **state)
{
    (void)state;
    int before = parallel_threads();
    for (int o = 0; o < OPERATIONS; o++)
        for (int t = 0; t < 2; t++) {
            cpu_tensor x = sized(types[t], 2, 1), y[2] = {tensor_like(&x), tensor_like(&x)};
            cpu_tensor dx[2] = {tensor_like(&x), tensor_like(&x)};
            for (int i = 0; i < 2; i++) {
                threads_use_here(i + 1);
                operations[o].forward(&x, &y[i]);
                operations[o].backward(&y[i], &x, &dx[i], false);
            }
            assert_same_bits(operations[o].name, &y[0], &y[1]);
            assert_same_bits(operations[o].name, &dx[0], &dx[1]);
            tensor_free(&x), tensor_free(&y[0]), tensor_free(&y[1]), tensor_free(&dx[0]), tensor_free(&dx[1]);
        }
    threads_use_here(before);
}

static void tanh_and_sigmoid_keep_their_stated_error(void **state)
{
    (void)state;
    for (double x = -20; x < 20; x += 0.001) {
        double t = tanh((double)(float)x), s = sigmoid((double)(float)x);
        assert_true(fabs((double)fast_tanh((float)x) - t) <= 3e-7 * fabs(t));
        assert_true(fabs((double)fast_sigmoid((float)x) - s) <= 3e-7 * s);
    }
    for (double x = 1e-30; x < 1; x *= 1.7)
        assert_true(fabs((double)fast_tanh((float)x) / tanh((double)(float)x) - 1) <= 3e-7);
    assert_true(fast_tanh(1e30f) == 1 && fast_tanh(-1e30f) == -1);
    assert_true(fast_sigmoid(1e30f) == 1 && fast_sigmoid(-1e30f) < 1e-37f);
}

static void nan_shows(void **state)
{
    (void)state;
    for (int o = 0; o < OPERATIONS; o++) {
        cpu_tensor x = sized(NN_FLOAT32, 1, 1), y = tensor_like(&x);
        tensor_set(&x, 5, NAN);
        operations[o].forward(&x, &y);
        assert_true(isnan(tensor_get(&y, 5)));
        tensor_free(&x), tensor_free(&y);
    }
}

static void casting_rounds_and_accumulates(void **state)
{
    (void)state;
    cpu_tensor x = sized(NN_FLOAT32, 2, 1), half = tensor_converted(&x, NN_BFLOAT16), y = tensor_like(&half);
    cpu_cast(&x, &y, false);
    assert_same_bits("to bfloat16", &y, &half);
    cpu_tensor back = sized(NN_FLOAT32, 2, 2), expected = tensor_like(&x);
    for (size_t i = 0; i < cpu_count(&x); i++)
        tensor_set(&expected, i, tensor_get(&back, i) + tensor_get(&half, i));
    cpu_cast(&half, &back, true);
    assert_same_bits("and added to float32", &back, &expected);
    cpu_cast(&half, &back, false);
    assert_near("back", &back, &half, 0, 0);
    cpu_zero(&back);
    for (size_t i = 0; i < cpu_count(&back); i++)
        assert_true(tensor_get(&back, i) == 0);
    tensor_free(&x), tensor_free(&half), tensor_free(&y), tensor_free(&back), tensor_free(&expected);
}

static void add_adds(void **state)
{
    (void)state;
    for (int t = 0; t < 2; t++) {
        cpu_tensor a = sized(types[t], 2, 1), b = sized(types[t], 2, 2), y = tensor_like(&a);
        cpu_tensor expected = tensor_converted(&a, NN_FLOAT32);
        for (size_t i = 0; i < cpu_count(&a); i++)
            tensor_set(&expected, i, tensor_get(&a, i) + tensor_get(&b, i));
        cpu_add(&a, &b, &y);
        assert_near("add", &y, &expected, tensor_rounding(types[t]), 0);
        tensor_free(&a), tensor_free(&b), tensor_free(&y), tensor_free(&expected);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(forward_follows_the_formula),
        cmocka_unit_test(slopes_are_the_derivatives_of_the_formulas),
        cmocka_unit_test(backward_is_the_slope_times_the_gradient),
        cmocka_unit_test(results_do_not_depend_on_the_number_of_threads),
        cmocka_unit_test(tanh_and_sigmoid_keep_their_stated_error),
        cmocka_unit_test(nan_shows),
        cmocka_unit_test(casting_rounds_and_accumulates),
        cmocka_unit_test(add_adds),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
