/* SPDX-License-Identifier: MIT */
#include "photo_stereo/subsets.h"

#include <stdlib.h>

#include "base/rng.h"

enum { SEED = 1, STREAM_SUBSET = 2 };

int subset_count(const merlin_capture *all)
{
    return all->count > SUBSET_PICTURES ? SUBSETS : 1;
}

/* Selects the first pictures of a shuffled order, borrowed. */
static void choose(const merlin_capture *all, int subset, merlin_capture *some)
{
    rng r = rng_at(SEED, (uint64_t)subset, STREAM_SUBSET);
    for (int i = 0; i < all->count; i++) {
        some->picture[i] = all->picture[i];
        some->light[i] = all->light[i];
        some->name[i] = all->name[i];
    }
    for (int i = 0; i < some->count; i++) {
        int other = i + rng_below(&r, all->count - i);
        uint16_t *picture = some->picture[i];
        merlin_light light = some->light[i];
        char *name = some->name[i];
        some->picture[i] = some->picture[other];
        some->light[i] = some->light[other];
        some->name[i] = some->name[other];
        some->picture[other] = picture;
        some->light[other] = light;
        some->name[other] = name;
    }
}

status subset_solve(const merlin_capture *all, int subset, merlin_stereo_method method, merlin_surface *out)
{
    *out = (merlin_surface){0};
    merlin_capture some = *all;
    size_t count = (size_t)all->count;
    some.picture = calloc(count, sizeof *some.picture);
    some.light = calloc(count, sizeof *some.light);
    some.name = calloc(count, sizeof *some.name);
    status s = OK;
    if (!some.picture || !some.light || !some.name) {
        s = fail(MERLIN_NO_MEMORY, "no memory for %d lights", all->count);
    } else {
        if (some.count > SUBSET_PICTURES) some.count = SUBSET_PICTURES;
        choose(all, subset, &some);
        if (method == MERLIN_STEREO_UNCALIBRATED) pst_capture_forget_lights(&some);
        s = pst_solve(&some, &(merlin_stereo_params){.method = method}, out);
    }
    free(some.picture);
    free(some.light);
    free(some.name);
    return s;
}
