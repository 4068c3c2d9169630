/* SPDX-License-Identifier: MIT */
/* The linear operations: each against its definition per element, and against its own adjoint. */
#include "tensors.h"

typedef struct shapes {
    int x[4], y[4];
} shapes;

typedef struct operation {
    const char *name;
    shapes (*shapes)(const int *base);
    double (*definition)(const cpu_tensor *x, int n, int row, int column, int c); /* the value of y there */
    void (*forward)(const cpu_tensor *x, cpu_tensor *y, bool accumulate);
    void (*adjoint)(const cpu_tensor *dy, cpu_tensor *dx, bool accumulate);
    bool forward_accumulates;
} operation;

static shapes double_size(const int *b)
{
    return (shapes){{b[0], b[1], b[2], b[3]}, {b[0], 2 * b[1], 2 * b[2], b[3]}};
}

static double clamped(const cpu_tensor *x, int n, int row, int column, int c)
{
    int y = row < 0 ? 0 : row >= x->h ? x->h - 1 : row, i = column < 0 ? 0 : column >= x->w ? x->w - 1 : column;
    return tensor_at(x, n, y, i, c);
}

/* Interpolates with half-pixel centres: output pixel i is at (i + 0.5)/2 - 0.5 of the input. */
static double bilinear(const cpu_tensor *x, int n, int row, int column, int c)
{
    double v = (row + 0.5) / 2 - 0.5, u = (column + 0.5) / 2 - 0.5;
    int j = (int)floor(v), i = (int)floor(u);
    v -= j, u -= i;
    return (1 - v) * ((1 - u) * clamped(x, n, j, i, c) + u * clamped(x, n, j, i + 1, c)) +
           v * ((1 - u) * clamped(x, n, j + 1, i, c) + u * clamped(x, n, j + 1, i + 1, c));
}

static void run_bilinear(const cpu_tensor *x, cpu_tensor *y, bool accumulate)
{
    (void)accumulate;
    cpu_upsample_bilinear(x, y);
}

static shapes tiled(const int *b)
{
    return (shapes){{b[0], 1, 1, b[3]}, {b[0], b[1], b[2], b[3]}};
}

static double tile(const cpu_tensor *x, int n, int row, int column, int c)
{
    (void)row, (void)column;
    return tensor_at(x, n, 0, 0, c);
}

static void run_tile(const cpu_tensor *x, cpu_tensor *y, bool accumulate)
{
    (void)accumulate;
    cpu_tile(x, y);
}

static shapes one_pixel(const int *b)
{
    return (shapes){{b[0], b[1], b[2], b[3]}, {b[0], 1, 1, b[3]}};
}

static double spatial_mean(const cpu_tensor *x, int n, int row, int column, int c)
{
    (void)row, (void)column;
    double sum = 0;
    for (int i = 0; i < x->h * x->w; i++)
        sum += tensor_at(x, n, i / x->w, i % x->w, c);
    return sum / (x->h * x->w);
}

static void run_spatial_mean(const cpu_tensor *x, cpu_tensor *y, bool accumulate)
{
    (void)accumulate;
    cpu_spatial_mean(x, y);
}

static shapes deeper(const int *b)
{
    return (shapes){{b[0], 2 * b[1], 2 * b[2], b[3]}, {b[0], b[1], b[2], 4 * b[3]}};
}

static double space_to_depth(const cpu_tensor *x, int n, int row, int column, int c)
{
    int block = c / x->c;
    return tensor_at(x, n, 2 * row + block / 2, 2 * column + block % 2, c % x->c);
}

static void run_space_to_depth(const cpu_tensor *x, cpu_tensor *y, bool accumulate)
{
    cpu_space_to_depth(x, y, 2, accumulate);
}

static void run_depth_to_space(const cpu_tensor *x, cpu_tensor *y, bool accumulate)
{
    cpu_depth_to_space(x, y, 2, accumulate);
}

static shapes shallower(const int *b)
{
    return (shapes){{b[0], b[1], b[2], 4 * b[3]}, {b[0], 2 * b[1], 2 * b[2], b[3]}};
}

static double depth_to_space(const cpu_tensor *x, int n, int row, int column, int c)
{
    return tensor_at(x, n, row / 2, column / 2, (row % 2 * 2 + column % 2) * (x->c / 4) + c);
}

enum { FIRST = 3, BEHIND = 2 };

static shapes wider(const int *b)
{
    return (shapes){{b[0], b[1], b[2], b[3]}, {b[0], b[1], b[2], FIRST + b[3] + BEHIND}};
}

static double insert_channels(const cpu_tensor *x, int n, int row, int column, int c)
{
    return c < FIRST || c >= FIRST + x->c ? 0 : tensor_at(x, n, row, column, c - FIRST);
}

static void run_insert(const cpu_tensor *x, cpu_tensor *y, bool accumulate)
{
    if (!accumulate) cpu_zero(y);
    cpu_insert_channels(x, y, FIRST, accumulate);
}

static void run_extract(const cpu_tensor *dy, cpu_tensor *dx, bool accumulate)
{
    cpu_extract_channels(dy, FIRST, dx, accumulate);
}

static const operation operations[] = {
    {"upsample_bilinear", double_size, bilinear, run_bilinear, cpu_upsample_bilinear_backward, false},
    {"tile", tiled, tile, run_tile, cpu_tile_backward, false},
    {"spatial_mean", one_pixel, spatial_mean, run_spatial_mean, cpu_spatial_mean_backward, false},
    {"space_to_depth", deeper, space_to_depth, run_space_to_depth, run_depth_to_space, true},
    {"depth_to_space", shallower, depth_to_space, run_depth_to_space, run_space_to_depth, true},
    {"insert_channels", wider, insert_channels, run_insert, run_extract, true},
};
enum { OPERATIONS = sizeof operations / sizeof *operations };

/* Shapes: one pixel, odd sizes, rows longer than a tile, channels wider than a chunk, enough for threads. */
static const int bases[][4] = {{1, 1, 1, 1}, {2, 3, 5, 7}, {1, 2, 300, 4}, {1, 3, 2, 1500}, {2, 17, 19, 32}};
enum { BASES = sizeof bases / sizeof *bases };

static cpu_tensor made(nn_type type, const int *shape, uint64_t seed)
{
    return tensor_random(type, shape[0], shape[1], shape[2], shape[3], seed);
}

static cpu_tensor defined(const operation *o, const cpu_tensor *x, const int *shape)
{
    cpu_tensor y = tensor_new(NN_FLOAT32, shape[0], shape[1], shape[2], shape[3]);
    for (int n = 0; n < y.n; n++)
        for (int row = 0; row < y.h; row++)
            for (int column = 0; column < y.w; column++)
                for (int c = 0; c < y.c; c++)
                    tensor_set(&y, tensor_index(&y, n, row, column, c), o->definition(x, n, row, column, c));
    return y;
}

static void check_forward(const operation *o, const int *base, nn_type type)
{
    shapes s = o->shapes(base);
    cpu_tensor x = made(type, s.x, 1), y = made(type, s.y, 2), expected = defined(o, &x, s.y);
    o->forward(&x, &y, false);
    assert_near(o->name, &y, &expected, tensor_rounding(type), 1e-6);
    tensor_free(&x), tensor_free(&y), tensor_free(&expected);
}

static void forward_follows_the_definition(void **state)
{
    (void)state;
    for (int o = 0; o < OPERATIONS; o++)
        for (int b = 0; b < BASES; b++) {
            check_forward(&operations[o], bases[b], NN_FLOAT32);
            check_forward(&operations[o], bases[b], NN_BFLOAT16);
        }
}

/* <A x, y> = <x, Aᵀ y>; each sum's rounding is below 1e-6 of the vectors' lengths. */
static void backward_is_the_adjoint(void **state)
{
    (void)state;
    for (int o = 0; o < OPERATIONS; o++)
        for (int b = 0; b < BASES; b++) {
            shapes s = operations[o].shapes(bases[b]);
            cpu_tensor x = made(NN_FLOAT32, s.x, 1), y = made(NN_FLOAT32, s.y, 2);
            cpu_tensor ax = tensor_like(&y), aty = made(NN_FLOAT32, s.x, 3);
            operations[o].forward(&x, &ax, false);
            operations[o].adjoint(&y, &aty, false);
            double left = tensor_dot(&ax, &y), right = tensor_dot(&x, &aty);
            double scale = sqrt(tensor_dot(&ax, &ax) * tensor_dot(&y, &y)) + 1;
            if (fabs(left - right) > 1e-6 * scale) fail_msg("%s: %.9g is not %.9g", operations[o].name, left, right);
            tensor_free(&x), tensor_free(&y), tensor_free(&ax), tensor_free(&aty);
        }
}

typedef void runner(const cpu_tensor *from, cpu_tensor *to, bool accumulate);

static void check_accumulation(const char *name, runner *run, const int *from, const int *to, nn_type type)
{
    cpu_tensor x = made(type, from, 1), before = made(type, to, 2), y = tensor_converted(&before, type);
    cpu_tensor alone = made(type, to, 3), expected = tensor_new(NN_FLOAT32, to[0], to[1], to[2], to[3]);
    run(&x, &alone, false);
    run(&x, &y, true);
    for (size_t i = 0; i < cpu_count(&y); i++)
        tensor_set(&expected, i, tensor_get(&before, i) + tensor_get(&alone, i));
    /* bfloat16: `alone` was rounded when it was stored, the sum again; |alone| is 16 at most (except tile's) */
    double largest = 1;
    for (size_t i = 0; i < cpu_count(&y); i++)
        largest = fmax(largest, fabs(tensor_get(&alone, i)));
    double absolute = type == NN_FLOAT32 ? 1e-6 * largest : BF16_ROUNDING * largest;
    assert_near(name, &y, &expected, tensor_rounding(type), absolute);
    tensor_free(&x), tensor_free(&before), tensor_free(&y), tensor_free(&alone), tensor_free(&expected);
}

static void accumulation_adds_to_what_is_there(void **state)
{
    (void)state;
    for (int i = 0; i < OPERATIONS; i++)
        for (int b = 0; b < BASES; b++) {
            const operation *o = &operations[i];
            shapes s = o->shapes(bases[b]);
            for (int t = NN_FLOAT32; t <= NN_BFLOAT16; t++) {
                check_accumulation(o->name, o->adjoint, s.y, s.x, (nn_type)t);
                if (o->forward_accumulates) check_accumulation(o->name, o->forward, s.x, s.y, (nn_type)t);
            }
        }
}

/* On values that bfloat16 represents, bfloat16 differs from float32 by the rounding of the result alone. */
static void bfloat16_backward_is_float32_rounded_once(void **state)
{
    (void)state;
    for (int o = 0; o < OPERATIONS; o++)
        for (int b = 0; b < BASES; b++) {
            shapes s = operations[o].shapes(bases[b]);
            cpu_tensor dy = made(NN_BFLOAT16, s.y, 1), dx = made(NN_BFLOAT16, s.x, 2);
            cpu_tensor dy32 = tensor_converted(&dy, NN_FLOAT32), dx32 = made(NN_FLOAT32, s.x, 3);
            operations[o].adjoint(&dy, &dx, false);
            operations[o].adjoint(&dy32, &dx32, false);
            assert_near(operations[o].name, &dx, &dx32, BF16_ROUNDING, 0);
            tensor_free(&dy), tensor_free(&dx), tensor_free(&dy32), tensor_free(&dx32);
        }
}

static void results_do_not_depend_on_the_number_of_threads(void **state)
{
    (void)state;
    int before = parallel_threads();
    for (int o = 0; o < OPERATIONS; o++) {
        shapes s = operations[o].shapes(bases[BASES - 1]);
        cpu_tensor x = made(NN_FLOAT32, s.x, 1), y[2] = {made(NN_FLOAT32, s.y, 2), made(NN_FLOAT32, s.y, 2)};
        cpu_tensor dx[2] = {tensor_like(&x), tensor_like(&x)};
        for (int i = 0; i < 2; i++) {
            threads_use_here(i + 1);
            operations[o].forward(&x, &y[i], false);
            operations[o].adjoint(&y[i], &dx[i], false);
        }
        assert_same_bits(operations[o].name, &y[0], &y[1]);
        assert_same_bits(operations[o].name, &dx[0], &dx[1]);
        tensor_free(&x), tensor_free(&y[0]), tensor_free(&y[1]), tensor_free(&dx[0]), tensor_free(&dx[1]);
    }
    threads_use_here(before);
}

/* Computed by hand: a row 0 4 8 becomes 0 1 3 5 7 8. */
static void bilinear_weights_are_three_quarters_and_one(void **state)
{
    (void)state;
    float row[] = {0, 4, 8}, out[12], expected[] = {0, 1, 3, 5, 7, 8};
    cpu_tensor x = {row, NN_FLOAT32, 1, 1, 3, 1}, y = {out, NN_FLOAT32, 1, 2, 6, 1};
    cpu_upsample_bilinear(&x, &y);
    for (int i = 0; i < 12; i++)
        assert_true(out[i] == expected[i % 6]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(forward_follows_the_definition),
        cmocka_unit_test(backward_is_the_adjoint),
        cmocka_unit_test(accumulation_adds_to_what_is_there),
        cmocka_unit_test(bfloat16_backward_is_float32_rounded_once),
        cmocka_unit_test(results_do_not_depend_on_the_number_of_threads),
        cmocka_unit_test(bilinear_weights_are_three_quarters_and_one),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
