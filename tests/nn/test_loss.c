/* SPDX-License-Identifier: MIT */
/* Masked losses against their definitions in double, gradients against central differences of those definitions. */
#include "tensors.h"

typedef struct loss {
    const char *name;
    float (*forward)(const cpu_tensor *prediction, const cpu_tensor *target, const cpu_tensor *mask, double *mask_sum);
    void (*backward)(const cpu_tensor *prediction, const cpu_tensor *target, const cpu_tensor *mask, double mask_sum,
                     float scale, cpu_tensor *dprediction, bool accumulate);
    double (*definition)(const cpu_tensor *prediction, const cpu_tensor *target, const cpu_tensor *mask);
    double rounding, step; /* rounding: of the loss in float, relative; step: of central differences */
} loss;

static double mask_total(const cpu_tensor *mask)
{
    double sum = 0;
    for (size_t i = 0; i < cpu_count(mask); i++)
        sum += tensor_get(mask, i);
    return sum;
}

static double masked_l2(const cpu_tensor *p, const cpu_tensor *t, const cpu_tensor *m)
{
    double sum = 0;
    for (size_t i = 0; i < cpu_count(p); i++)
        sum += pow((tensor_get(p, i) - tensor_get(t, i)) * tensor_get(m, i / (size_t)p->c), 2);
    return sum / mask_total(m);
}

static double step_error(const cpu_tensor *p, const cpu_tensor *t, const cpu_tensor *m, size_t a, size_t b)
{
    size_t channels = (size_t)p->c;
    if (tensor_get(m, a / channels) <= 0.5 || tensor_get(m, b / channels) <= 0.5) return 0;
    return pow((tensor_get(p, b) - tensor_get(p, a)) - (tensor_get(t, b) - tensor_get(t, a)), 2);
}

static double masked_gradient_l2(const cpu_tensor *p, const cpu_tensor *t, const cpu_tensor *m)
{
    double sum = 0;
    for (int n = 0; n < p->n; n++)
        for (int y = 0; y < p->h; y++)
            for (int x = 0; x < p->w; x++)
                for (int c = 0; c < p->c; c++) {
                    size_t here = tensor_index(p, n, y, x, c);
                    if (x + 1 < p->w) sum += step_error(p, t, m, here, tensor_index(p, n, y, x + 1, c));
                    if (y + 1 < p->h) sum += step_error(p, t, m, here, tensor_index(p, n, y + 1, x, c));
                }
    return sum / mask_total(m);
}

/* Computes the dissimilarity from the five moments of the 11 × 11 window around a pixel, black beyond the frame. */
static double dissimilarity_at(const cpu_tensor *p, const cpu_tensor *t, const cpu_tensor *m, size_t n, int row,
                               int column, size_t channel)
{
    double moment[5] = {0}, total = 0;
    for (int dy = -5; dy <= 5; dy++)
        for (int dx = -5; dx <= 5; dx++) {
            double weight = exp(-(dx * dx + dy * dy) / (2 * 1.5 * 1.5));
            int y = row + dy, x = column + dx;
            total += weight;
            if (x < 0 || y < 0 || x >= p->w || y >= p->h) continue;
            size_t pixel = (n * (size_t)p->h + (size_t)y) * (size_t)p->w + (size_t)x,
                   i = pixel * (size_t)p->c + channel;
            double a = tensor_get(p, i) * tensor_get(m, pixel), b = tensor_get(t, i) * tensor_get(m, pixel);
            const double values[5] = {a, b, a * a, b * b, a * b};
            for (int k = 0; k < 5; k++)
                moment[k] += weight * values[k];
        }
    for (int k = 0; k < 5; k++)
        moment[k] /= total;
    double a = moment[0], b = moment[1], c1 = 1e-4, c2 = 9e-4;
    return 1 - (2 * a * b + c1) * (2 * (moment[4] - a * b) + c2) /
                   ((a * a + b * b + c1) * (moment[2] - a * a + moment[3] - b * b + c2));
}

static double masked_dssim(const cpu_tensor *p, const cpu_tensor *t, const cpu_tensor *m)
{
    double sum = 0;
    for (int n = 0; n < p->n; n++)
        for (int y = 0; y < p->h; y++)
            for (int x = 0; x < p->w; x++)
                for (int c = 0; c < p->c; c++)
                    sum += dissimilarity_at(p, t, m, (size_t)n, y, x, (size_t)c);
    return sum / (mask_total(m) * p->c);
}

static float dssim_forward(const cpu_tensor *p, const cpu_tensor *t, const cpu_tensor *m, double *mask_sum)
{
    float value = NAN;
    assert_int_equal(cpu_masked_dssim(p, t, m, mask_sum, &value), OK);
    return value;
}

static void dssim_backward(const cpu_tensor *p, const cpu_tensor *t, const cpu_tensor *m, double mask_sum, float scale,
                           cpu_tensor *dp, bool accumulate)
{
    assert_int_equal(cpu_masked_dssim_backward(p, t, m, mask_sum, scale, dp, accumulate), OK);
}

/* Losses. Differences are rounded to float before they are squared, moments before they are subtracted. The first two
 * are quadratic, so that a wide step of central differences is exact except for the float grid; the third is not. */
static const loss losses[] = {
    {"masked_l2", cpu_masked_l2, cpu_masked_l2_backward, masked_l2, 1e-6, 1.0 / 1024},
    {"masked_gradient_l2", cpu_masked_gradient_l2, cpu_masked_gradient_l2_backward, masked_gradient_l2, 1e-6,
     1.0 / 1024},
    {"masked_dssim", dssim_forward, dssim_backward, masked_dssim, 2e-6, 1.0 / 16384},
};
enum { LOSSES = sizeof losses / sizeof *losses };

static const int bases[][4] = {{1, 1, 1, 1}, {2, 5, 7, 1}, {2, 6, 5, 3}, {1, 4, 3, 5}, {3, 67, 61, 3}};
enum { BASES = sizeof bases / sizeof *bases };

typedef struct operands {
    cpu_tensor prediction, target, mask;
} operands;

static operands operands_new(const int *b)
{
    operands o = {tensor_random(NN_FLOAT32, b[0], b[1], b[2], b[3], 1),
                  tensor_random(NN_FLOAT32, b[0], b[1], b[2], b[3], 2), tensor_new(NN_FLOAT32, b[0], b[1], b[2], 1)};
    static const double values[] = {1, 1, 0, 0.75, 1, 0.25, 1};
    for (size_t i = 0; i < cpu_count(&o.mask); i++)
        tensor_set(&o.mask, i, values[i * i % 7]);
    tensor_set(&o.mask, 0, 1);
    return o;
}

static void operands_free(operands *o)
{
    tensor_free(&o->prediction), tensor_free(&o->target), tensor_free(&o->mask);
}

static void losses_follow_their_definitions(void **state)
{
    (void)state;
    for (int l = 0; l < LOSSES; l++)
        for (int b = 0; b < BASES; b++) {
            operands o = operands_new(bases[b]);
            double sum = 0, expected = losses[l].definition(&o.prediction, &o.target, &o.mask);
            double found = (double)losses[l].forward(&o.prediction, &o.target, &o.mask, &sum);
            assert_true(fabs(found - expected) <= losses[l].rounding * expected);
            assert_true(fabs(sum - mask_total(&o.mask)) < 1e-9);
            operands_free(&o);
        }
}

static void gradients_are_those_of_central_differences(void **state)
{
    (void)state;
    const float scale = 0.3f;
    for (int l = 0; l < LOSSES; l++)
        for (int b = 0; b < BASES - 1; b++)
            for (int accumulate = 0; accumulate < 2; accumulate++) {
                operands o = operands_new(bases[b]);
                cpu_tensor d = tensor_random(NN_FLOAT32, bases[b][0], bases[b][1], bases[b][2], bases[b][3], 3);
                cpu_tensor expected = tensor_like(&d);
                double h = losses[l].step;
                for (size_t i = 0; i < cpu_count(&d); i++) {
                    double at = tensor_get(&o.prediction, i);
                    tensor_set(&o.prediction, i, at + h);
                    double above = losses[l].definition(&o.prediction, &o.target, &o.mask);
                    double high = tensor_get(&o.prediction, i);
                    tensor_set(&o.prediction, i, at - h);
                    double slope = (above - losses[l].definition(&o.prediction, &o.target, &o.mask)) /
                                   (high - tensor_get(&o.prediction, i));
                    tensor_set(&o.prediction, i, at);
                    tensor_set(&expected, i, (double)scale * slope + (accumulate ? tensor_get(&d, i) : 0));
                }
                double sum = mask_total(&o.mask);
                losses[l].backward(&o.prediction, &o.target, &o.mask, sum, scale, &d, accumulate);
                assert_near(losses[l].name, &d, &expected, 1e-4, 1e-6);
                tensor_free(&d), tensor_free(&expected);
                operands_free(&o);
            }
}

static void what_lies_outside_the_mask_does_not_matter(void **state)
{
    (void)state;
    for (int l = 0; l < LOSSES; l++) {
        operands o = operands_new(bases[2]), clean = operands_new(bases[2]);
        cpu_tensor d = tensor_like(&o.prediction);
        for (size_t i = 0; i < cpu_count(&o.prediction); i++)
            if (tensor_get(&o.mask, i / 3) == 0) tensor_set(&o.prediction, i, NAN), tensor_set(&o.target, i, INFINITY);
        double sum;
        float a = losses[l].forward(&o.prediction, &o.target, &o.mask, &sum);
        assert_true(a == losses[l].forward(&clean.prediction, &clean.target, &clean.mask, &sum));
        losses[l].backward(&o.prediction, &o.target, &o.mask, sum, 1, &d, false);
        for (size_t i = 0; i < cpu_count(&d); i++) {
            assert_true(isfinite(tensor_get(&d, i)));
            if (tensor_get(&o.mask, i / 3) == 0) assert_true(tensor_get(&d, i) == 0);
        }
        tensor_free(&d);
        operands_free(&o), operands_free(&clean);
    }
}

static void an_empty_mask_costs_nothing(void **state)
{
    (void)state;
    for (int l = 0; l < LOSSES; l++) {
        operands o = operands_new(bases[2]);
        cpu_tensor d = tensor_random(NN_FLOAT32, 2, 6, 5, 3, 9);
        cpu_zero(&o.mask);
        double sum = -1;
        assert_true(losses[l].forward(&o.prediction, &o.target, &o.mask, &sum) == 0 && sum == 0);
        losses[l].backward(&o.prediction, &o.target, &o.mask, sum, 1, &d, false);
        for (size_t i = 0; i < cpu_count(&d); i++)
            assert_true(tensor_get(&d, i) == 0);
        tensor_free(&d);
        operands_free(&o);
    }
}

static void results_do_not_depend_on_the_number_of_threads(void **state)
{
    (void)state;
    int before = parallel_threads();
    for (int l = 0; l < LOSSES; l++) {
        operands o = operands_new(bases[BASES - 1]);
        cpu_tensor d[2] = {tensor_like(&o.prediction), tensor_like(&o.prediction)};
        float value[2];
        for (int i = 0; i < 2; i++) {
            double sum;
            threads_use_here(i + 1);
            value[i] = losses[l].forward(&o.prediction, &o.target, &o.mask, &sum);
            losses[l].backward(&o.prediction, &o.target, &o.mask, sum, 1, &d[i], false);
        }
        assert_true(value[0] == value[1]);
        assert_same_bits(losses[l].name, &d[0], &d[1]);
        tensor_free(&d[0]), tensor_free(&d[1]);
        operands_free(&o);
    }
    threads_use_here(before);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(losses_follow_their_definitions),
        cmocka_unit_test(gradients_are_those_of_central_differences),
        cmocka_unit_test(what_lies_outside_the_mask_does_not_matter),
        cmocka_unit_test(an_empty_mask_costs_nothing),
        cmocka_unit_test(results_do_not_depend_on_the_number_of_threads),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
