/* SPDX-License-Identifier: MIT */
/* Content of a weights file, by the public functions. */
#include <string.h>

#include "merlin/merlin.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

static const char *const shipped = MERLIN_SOURCE_DIR "/models/merlin-point.safetensors";

static void tensors_hold_all_parameters_and_statistics(void **unused)
{
    (void)unused;
    merlin_weights weights;
    size_t sum = 0;
    assert_int_equal(merlin_weights_read(shipped, &weights), MERLIN_OK);
    for (size_t i = 0; i < weights.tensor_count; i++) {
        size_t count = 1;
        const char *type = weights.tensors[i].type;
        assert_true(weights.tensors[i].name[0] && weights.tensors[i].rank <= 4);
        assert_true(strcmp(type, "F16") == 0 || strcmp(type, "F32") == 0);
        for (int k = 0; k < weights.tensors[i].rank; k++)
            count *= (size_t)weights.tensors[i].shape[k];
        sum += count;
    }
    assert_int_equal(sum, weights.parameters + weights.statistics);
    assert_true(weights.parameters > 100 * weights.statistics && weights.statistics > 0);
    merlin_weights_free(&weights);
}

static void weights_tell_their_model_and_its_cost(void **unused)
{
    (void)unused;
    merlin_weights weights;
    assert_int_equal(merlin_weights_read(shipped, &weights), MERLIN_OK);
    assert_string_equal(weights.name, "merlin-point");
    assert_true(weights.gmac > 1 && weights.gmac < 100);
    assert_non_null(strstr(merlin_weights_metadata(&weights, "config"), "\"merlin-point\""));
    assert_non_null(merlin_weights_metadata(&weights, "training"));
    assert_null(merlin_weights_metadata(&weights, "no such thing"));
    merlin_weights_free(&weights);
    assert_null(merlin_weights_metadata(&weights, "config"));
}

static void what_is_no_weights_file_is_refused(void **unused)
{
    (void)unused;
    merlin_weights weights;
    assert_int_equal(merlin_weights_read(__FILE__, &weights), MERLIN_BAD_INPUT);
    assert_non_null(strstr(merlin_error(), "test_weights.c"));
    assert_null(weights.tensors);
    assert_int_equal(merlin_weights_read(NULL, &weights), MERLIN_WRONG_USE);
    assert_int_equal(merlin_weights_read(shipped, NULL), MERLIN_WRONG_USE);
    merlin_weights_free(NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(tensors_hold_all_parameters_and_statistics),
        cmocka_unit_test(weights_tell_their_model_and_its_cost),
        cmocka_unit_test(what_is_no_weights_file_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
