/* Parameters from safetensors files: all or nothing. */
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <setjmp.h>

#include "nn/nn.h"
#include "nn/safetensors.h"

#include <cmocka.h> /* last: it defines fail as a macro */

enum { MOST = 16 };

static char path[] = "/tmp/merlin-test-XXXXXX";

static nn_graph *build_net(void)
{
    nn_graph *g = nn_graph_new();
    nn_node *x = nn_conv2d(g, nn_compute(g, nn_input(g, "x", 3, 1)), "conv", 4, 3, 1, NN_BIAS);
    nn_batch_norm(g, x, "norm");
    return g;
}

static nn_params *new_params(uint64_t seed)
{
    nn_graph *g = build_net();
    nn_params *params;
    assert_int_equal(nn_params_new(g, seed, &params), OK);
    nn_graph_free(g);
    return params;
}

/* Describes all parameters; returns how many. */
static size_t describe(nn_params *params, st_tensor *tensors)
{
    size_t count = nn_params_count(params);
    for (size_t i = 0; i < count; i++) {
        const nn_param *p = nn_params_at(params, i);
        tensors[i] = (st_tensor){.name = p->name, .type = ST_F32, .rank = p->rank, .count = p->count, .data = p->value};
        memcpy(tensors[i].shape, p->shape, sizeof p->shape);
    }
    return count;
}

static void saved_parameters_are_loaded(void **state)
{
    (void)state;
    nn_params *a = new_params(1), *b = new_params(2);
    st_tensor tensors[MOST];
    assert_int_equal(st_write(path, tensors, describe(a, tensors), NULL, 0), OK);
    assert_int_equal(nn_params_load(b, path), OK);
    for (size_t i = 0; i < nn_params_count(a); i++)
        assert_memory_equal(nn_params_at(a, i)->value, nn_params_at(b, i)->value,
                            nn_params_at(a, i)->count * sizeof(float));
    nn_params_free(a);
    nn_params_free(b);
}

/* Writes the tensors and loads them into other parameters, which must refuse with these words and stay as they were. */
static void assert_refused(const st_tensor *tensors, size_t count, const char *words)
{
    nn_params *b = new_params(2), *untouched = new_params(2);
    assert_int_equal(st_write(path, tensors, count, NULL, 0), OK);
    assert_int_equal(nn_params_load(b, path), ERROR_INPUT);
    if (!strstr(status_message(), words)) fail_msg("\"%s\" is not in \"%s\"", words, status_message());
    for (size_t i = 0; i < nn_params_count(b); i++)
        assert_memory_equal(nn_params_at(b, i)->value, nn_params_at(untouched, i)->value,
                            nn_params_at(b, i)->count * sizeof(float));
    nn_params_free(b);
    nn_params_free(untouched);
}

static void tensors_that_do_not_fit_are_refused(void **state)
{
    (void)state;
    nn_params *a = new_params(1);
    st_tensor tensors[MOST];
    size_t count = describe(a, tensors);
    assert_refused(tensors, count - 1, "norm.running_var is missing");
    tensors[count] = tensors[0];
    tensors[count].name = "stranger";
    assert_refused(tensors, count + 1, "stranger");
    describe(a, tensors);
    tensors[0].shape[0] = 3;
    tensors[0].shape[1] = 4;
    assert_refused(tensors, count, "conv.weight has another shape");
    nn_params_free(a);
}

static void tensors_that_fit_are_shared_and_the_rest_stays(void **state)
{
    (void)state;
    nn_params *a = new_params(1), *b = new_params(2), *before = new_params(2);
    st_tensor tensors[MOST];
    size_t count = describe(a, tensors);
    /* a stranger, one missing, one of another shape */
    tensors[0].shape[0] = 3;
    tensors[0].shape[1] = 4;
    tensors[1].name = "stranger";
    nn_params_at(a, 2)->value[0] = 42;
    assert_int_equal(st_write(path, tensors, count, NULL, 0), OK);
    assert_int_equal(nn_params_load_shared(b, path), OK);
    for (size_t i = 0; i < count; i++) {
        const nn_param *expected = nn_params_at(i < 2 ? before : a, i);
        assert_memory_equal(nn_params_at(b, i)->value, expected->value, expected->count * sizeof(float));
    }
    assert_true(nn_params_at(b, 2)->value[0] == 42);
    assert_int_equal(st_write(path, tensors, 2, NULL, 0), OK);
    assert_int_equal(nn_params_load_shared(b, path), ERROR_INPUT);
    assert_non_null(strstr(status_message(), "no tensor fits"));
    nn_params_free(a);
    nn_params_free(b);
    nn_params_free(before);
}

static int make_file(void **state)
{
    (void)state;
    int file = mkstemp(path);
    return file < 0 ? -1 : close(file);
}

static int remove_file(void **state)
{
    (void)state;
    return remove(path);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(saved_parameters_are_loaded),
        cmocka_unit_test(tensors_that_do_not_fit_are_refused),
        cmocka_unit_test(tensors_that_fit_are_shared_and_the_rest_stays),
    };
    return cmocka_run_group_tests(tests, make_file, remove_file);
}
