/* SPDX-License-Identifier: MIT */
/* merlin_environment: an environment map from a file. */
#include <float.h>
#include <math.h>
#include <stdlib.h>

#include "base/api_needs.h"
#include "estimate/relight/relighter.h"
#include "image/read/read.h"
#include "merlin/merlin.h"

/* Mean luminance of well-lit samples in the training data (render/environment.c). */
static const float MEAN_LUMINANCE = 1.0f;
static const float MOST_EXPOSURE = 20.0f;

/* Returns the share of negative values; those close to zero result from resizing or compression and do not count. */
static double share_negative(const img *picture)
{
    const double nothing = 1e-3; /* limit relative to the mean */
    double sum = 0;
    size_t count = img_value_count(picture), negative = 0;
    for (size_t i = 0; i < count; i++)
        if (picture->data[i] > 0) sum += (double)picture->data[i];
    for (size_t i = 0; i < count; i++)
        negative += (double)picture->data[i] < -nothing * sum / (double)count;
    return (double)negative / (double)count;
}

/* Divides by a power of two, which rounds nothing: sums over the largest floats would not be finite. */
static void bring_to_one(img *picture)
{
    float most = 0;
    int exponent;
    size_t count = img_value_count(picture);
    for (size_t i = 0; i < count; i++)
        if (isfinite(picture->data[i])) most = fmaxf(most, picture->data[i]);
    frexpf(most, &exponent);
    float factor = ldexpf(1, -exponent > FLT_MAX_EXP - 1 ? FLT_MAX_EXP - 1 : -exponent);
    for (size_t i = 0; i < count; i++)
        picture->data[i] *= factor;
}

static status prepare(const char *path, float turn, float exposure, env_map *map)
{
    float mean = env_map_mean(map);
    if (!(mean > 0)) return fail(MERLIN_BAD_INPUT, "%s is black all over: no light to relight by", path);
    env_map_scale(map, MEAN_LUMINANCE * exp2f(exposure) / mean);
    env_map_turn(map, turn);
    return OK;
}

merlin_status merlin_environment_read(const char *path, float turn, float exposure, merlin_environment **out)
{
    if (out) *out = NULL;
    status s = api_needs(__func__, path && out);
    if (s != OK) return s;
    if (!isfinite(turn) || !(fabsf(exposure) <= MOST_EXPOSURE))
        return fail(MERLIN_WRONG_USE, "an environment's turn must be finite and its exposure within %g EV",
                    (double)MOST_EXPOSURE);
    merlin_environment *e = calloc(1, sizeof *e);
    if (!e) return fail(MERLIN_NO_MEMORY, "no memory for an environment");
    img picture = {0};
    s = img_read_latlong(path, &picture);
    if (s == OK) e->negative = share_negative(&picture);
    if (s == OK) bring_to_one(&picture);
    if (s == OK) s = env_map_new(&picture, &e->map);
    if (s == OK) s = prepare(path, turn, exposure, &e->map);
    img_free(&picture);
    if (s != OK)
        merlin_environment_free(e);
    else
        *out = e;
    return s;
}

void merlin_environment_free(merlin_environment *e)
{
    if (!e) return;
    env_map_free(&e->map);
    free(e);
}

void merlin_environment_turn(merlin_environment *e, float turn)
{
    if (e && isfinite(turn)) env_map_turn(&e->map, turn);
}

double merlin_environment_negative(const merlin_environment *e)
{
    return e ? e->negative : 0;
}
