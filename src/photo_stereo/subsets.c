/* SPDX-License-Identifier: MIT */
#include "photo_stereo/subsets.h"

#include <stdlib.h>

#include "base/rng.h"

enum { SEED = 1, STREAM_SUBSET = 2 };

int subset_count(const merlin_capture *all, int pictures)
{
    return all->count > pictures ? SUBSETS : 1;
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
        pst_plane picture = some->picture[i];
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

status subset_new(const merlin_capture *all, int subset, int pictures, merlin_capture *out)
{
    const size_t count = (size_t)all->count;
    *out = *all;
    out->picture = calloc(count, sizeof *out->picture);
    out->light = calloc(count, sizeof *out->light);
    out->name = calloc(count, sizeof *out->name);
    if (!out->picture || !out->light || !out->name) {
        subset_free(out);
        return fail(MERLIN_NO_MEMORY, "no memory for %d lights", all->count);
    }
    if (out->count > pictures) out->count = pictures;
    choose(all, subset, out);
    return OK;
}

void subset_free(merlin_capture *subset)
{
    free(subset->picture);
    free(subset->light);
    free(subset->name);
    *subset = (merlin_capture){0};
}

status subset_solve_guided(const merlin_capture *all, int subset, int pictures, const merlin_stereo_params *params,
                           const pst_guide *guide, merlin_surface *out)
{
    merlin_capture some;
    *out = (merlin_surface){0};
    status s = subset_new(all, subset, pictures, &some);
    if (s != OK) return s;
    if (params->method == MERLIN_STEREO_UNCALIBRATED) pst_capture_forget_lights(&some);
    s = pst_solve_guided(&some, params, guide, out);
    subset_free(&some);
    return s;
}

status subset_solve(const merlin_capture *all, int subset, merlin_stereo_method method, merlin_surface *out)
{
    return subset_solve_guided(all, subset, SUBSET_PICTURES, &(merlin_stereo_params){.method = method}, NULL, out);
}
