/* SPDX-License-Identifier: MIT */
/* Tests merlin_estimate in two steps, and what is heard of it. */
#include "estimate_fixture.h"

static merlin_image copy_of(const merlin_image *image)
{
    merlin_image copy = image_new(image->width, image->height, image->channels);
    memcpy(copy.data, image->data, (size_t)(image->width * image->height * image->channels) * sizeof(float));
    return copy;
}

static void assert_same(const merlin_image *a, const merlin_image *b)
{
    assert_int_equal(a->channels, b->channels);
    assert_memory_equal(a->data, b->data, (size_t)(a->width * a->height * a->channels) * sizeof(float));
}

static void two_steps_make_the_same_maps_and_empty_what_they_took(void **state)
{
    const fixture *f = *state;
    for (int found = 0; found < 2; found++) {
        const merlin_image *mask = found ? NULL : &f->mask;
        merlin_image photo = copy_of(&f->photo);
        merlin_object object;
        merlin_maps once, twice;
        const merlin_params p = small();
        assert_int_equal(merlin_estimate(f->model, &f->photo, mask, &p, &once), MERLIN_OK);
        assert_int_equal(merlin_object_find(&photo, mask, NULL, &object), MERLIN_OK);
        assert_int_equal(object.source, found ? MERLIN_MASK_FOUND : MERLIN_MASK_GIVEN);
        assert_true(found ? object.confidence <= 1 : object.confidence == 1);
        assert_int_equal(merlin_model_prepare(f->model, &p), MERLIN_OK);
        assert_int_equal(merlin_estimate_object(f->model, &photo, &object, &p, &twice), MERLIN_OK);
        assert_null(photo.data);
        assert_null(object.mask.data);
        assert_same(&once.albedo, &twice.albedo);
        assert_same(&once.normal, &twice.normal);
        assert_same(&once.mask, &twice.mask);
        assert_int_equal(once.doubts, twice.doubts);
        assert_true(once.mask_confidence == twice.mask_confidence && once.mask_source == twice.mask_source);
        merlin_maps_free(&once);
        merlin_maps_free(&twice);
    }
}

static void a_last_photograph_has_the_same_maps(void **state)
{
    const fixture *f = *state;
    merlin_params p = small();
    merlin_maps usual, last;
    merlin_image relit;
    assert_int_equal(merlin_estimate(f->model, &f->photo, &f->mask, &p, &usual), MERLIN_OK);
    p.last = 1;
    assert_int_equal(merlin_estimate(f->model, &f->photo, &f->mask, &p, &last), MERLIN_OK);
    assert_same(&usual.normal, &last.normal);
    assert_int_equal(merlin_relight(f->model, &last, (const float[]){0.3f, 0, -0.3f}, MERLIN_BY_BRDF, &relit),
                     MERLIN_OK);
    merlin_image_free(&relit);
    merlin_maps_free(&usual);
    merlin_maps_free(&last);
}

static void an_object_of_another_photograph_is_refused_and_freed(void **state)
{
    const fixture *f = *state;
    merlin_image photo = image_new(WIDTH, HEIGHT + 1, 3);
    merlin_object object;
    merlin_maps maps;
    assert_int_equal(merlin_object_find(&f->photo, &f->mask, NULL, &object), MERLIN_OK);
    assert_int_equal(merlin_estimate_object(f->model, &photo, &object, NULL, &maps), MERLIN_WRONG_USE);
    assert_null(photo.data);
    assert_null(object.mask.data);
    assert_null(maps.albedo.data);
    assert_int_equal(merlin_estimate_object(f->model, &photo, &object, NULL, &maps), MERLIN_WRONG_USE); /* both empty */
    merlin_object_free(&object);
    merlin_object_free(NULL);
}

static void a_model_is_not_made_ready_for_what_cannot_be(void **state)
{
    const fixture *f = *state;
    merlin_params p = small();
    assert_int_equal(merlin_model_prepare(NULL, &p), MERLIN_WRONG_USE);
    p.size = MERLIN_LARGEST_SIZE + MERLIN_SIZE_STEP;
    assert_int_equal(merlin_model_prepare(f->model, &p), MERLIN_WRONG_USE);
    p.size = 64;
    p.views = 9;
    assert_int_equal(merlin_model_prepare(f->model, &p), MERLIN_WRONG_USE);
}

typedef struct heard {
    int estimating, refining;
    float last;
} heard;

static void hear(void *context, const char *stage, float share)
{
    heard *h = context;
    assert_true(share >= 0 && share <= 1);
    h->estimating += strcmp(stage, "estimating") == 0;
    h->refining += strcmp(stage, "refining") == 0;
    h->last = share;
}

static void progress_is_heard(void **state)
{
    const fixture *f = *state;
    merlin_params p = small();
    merlin_maps maps;
    heard h = {0};
    p.progress = hear;
    p.progress_context = &h;
    assert_int_equal(merlin_estimate(f->model, &f->photo, &f->mask, &p, &maps), MERLIN_OK);
    assert_true(h.estimating >= 1 && h.refining >= 2 && h.last > 0);
    merlin_maps_free(&maps);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(two_steps_make_the_same_maps_and_empty_what_they_took),
        cmocka_unit_test(a_last_photograph_has_the_same_maps),
        cmocka_unit_test(an_object_of_another_photograph_is_refused_and_freed),
        cmocka_unit_test(a_model_is_not_made_ready_for_what_cannot_be),
        cmocka_unit_test(progress_is_heard),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
