/* SPDX-License-Identifier: MIT */
/* Values at sampled points of maps, and their gradients. */
#include "nn/cpu/kernels/gather.h"
#include "tensors.h"

/* Returns a map whose value is linear in its pixel's place in a picture twice as large. */
static cpu_tensor slanted(nn_type type)
{
    cpu_tensor x = tensor_new(type, 4, 6, 5, 2);
    for (size_t i = 0; i < cpu_count(&x); i++) {
        const size_t pixel = i / 2 % 30, image = i / 60;
        const double column = 2.0 * (double)(pixel % 5) + 0.5, row = 2.0 * (double)(pixel / 5) + 0.5;
        tensor_set(&x, i, i % 2 ? 8 * (double)image + row : column / 2 - row);
    }
    return x;
}

/* Two objects of two pictures and three points; the last lies beyond the lower right corner, where the map ends at
 * column 8.5 and row 10.5. */
static cpu_tensor three_places(void)
{
    static const float at[] = {2, 3, 4.25f, 6.5f, 30, 30, 0.5f, 0.5f, 8.5f, 1.5f, 40, NAN};
    cpu_tensor places = tensor_new(NN_FLOAT32, 2, 1, 3, 2);
    memcpy(places.data, at, sizeof at);
    return places;
}

static void points_are_interpolated_and_those_outside_moved_to_the_border(void **state)
{
    (void)state;
    static const double columns[] = {2, 4.25, 8.5, 0.5, 8.5, 8.5}, rows[] = {3, 6.5, 10.5, 0.5, 1.5, 0.5};
    for (int t = NN_FLOAT32; t <= NN_BFLOAT16; t++) {
        cpu_tensor x = slanted((nn_type)t), places = three_places(), y = tensor_new((nn_type)t, 4, 1, 3, 2);
        cpu_gather(&x, &(cpu_places){&places, 2}, &y);
        for (int image = 0; image < 4; image++)
            for (int point = 0; point < 3; point++) {
                const int k = image / 2 * 3 + point;
                const double expected[] = {columns[k] / 2 - rows[k], 8 * image + rows[k]};
                for (int c = 0; c < 2; c++)
                    assert_float_equal(tensor_at(&y, image, 0, point, c), expected[c], t == NN_FLOAT32 ? 1e-5 : 0.2);
            }
        tensor_free(&x), tensor_free(&places), tensor_free(&y);
    }
}

/* Interpolation is linear: <gather(x), d> = <x, gather's gradient of d>. */
static void gradients_of_points_are_the_transpose(void **state)
{
    (void)state;
    for (int t = NN_FLOAT32; t <= NN_BFLOAT16; t++)
        for (int accumulate = 0; accumulate < 2; accumulate++) {
            cpu_tensor x = tensor_random((nn_type)t, 4, 6, 5, 33, 1), dx = tensor_random((nn_type)t, 4, 6, 5, 33, 2);
            cpu_tensor places = three_places(), y = tensor_new((nn_type)t, 4, 1, 3, 33), dy = tensor_like(&y);
            float *sums = malloc(cpu_count(&x) * sizeof *sums);
            tensor_fill(&dy, 3, -1, 1);
            double before = accumulate ? tensor_dot(&dx, &x) : 0;
            cpu_gather(&x, &(cpu_places){&places, 2}, &y);
            cpu_gather_backward(&(cpu_places){&places, 2}, &dy, &dx, accumulate, sums);
            /* sums of some 400 products; of bfloat16 with errors of 2^-9 each, which mostly cancel */
            assert_float_equal(tensor_dot(&dx, &x) - before, tensor_dot(&dy, &y), t == NN_FLOAT32 ? 1e-4 : 0.3);
            free(sums);
            tensor_free(&x), tensor_free(&dx), tensor_free(&places), tensor_free(&y), tensor_free(&dy);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(points_are_interpolated_and_those_outside_moved_to_the_border),
        cmocka_unit_test(gradients_of_points_are_the_transpose),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
