/* SPDX-License-Identifier: MIT */
/* merlin_relighter: maps prepared for many lights (merlin/relight.h). */
#include <math.h>
#include <stdlib.h>

#include "base/api_needs.h"
#include "estimate/photo/model_pair.h"
#include "estimate/relight/lamp_of.h"
#include "estimate/relight/maps_surface.h"
#include "estimate/relight/relighter.h"

enum { LARGEST_SIDE = 8000 };

struct merlin_relighter {
    network *network;
    relighter relighter;
    crop_square crop;  /* crop of the photograph */
    int width, height; /* size of the photograph */
};

static status check_side(int side)
{
    if (side >= 0 && side <= LARGEST_SIDE) return OK;
    return fail(MERLIN_WRONG_USE, "a relighter's side is 0 (as in the photograph) to %d pixels, not %d", LARGEST_SIDE,
                side);
}

merlin_status merlin_relighter_new(merlin_model *model, const merlin_maps *maps, int side, merlin_relighting how,
                                   merlin_relighter **out)
{
    if (out) *out = NULL;
    status s = api_needs(__func__, model && maps && out);
    const lamp flash = lamp_at(vec3_make(0, 0, 0));
    if (s == OK) s = relighter_check(how, &flash, false);
    if (s == OK) s = check_side(side);
    if (s != OK) return s;
    merlin_relighter *made = calloc(1, sizeof *made);
    if (!made) return fail(MERLIN_NO_MEMORY, "no memory for a relighter");
    *made = (merlin_relighter){.network = model_network(model, maps, how),
                               .crop = crop_of(maps),
                               .width = maps->mask.width,
                               .height = maps->mask.height};
    s = relighter_new(made->network, maps, side, how, &made->relighter);
    if (s != OK)
        free(made);
    else
        *out = made;
    return s;
}

void merlin_relighter_free(merlin_relighter *st)
{
    if (!st) return;
    relighter_free(&st->relighter);
    free(st);
}

/* ---- light ---- */

static status check_lamp(const merlin_lamp *l)
{
    const vec3 at = vec3_of(l->at);
    bool sound = isfinite(at.x) && isfinite(at.y) && isfinite(at.z);
    if (!sound) return fail(MERLIN_WRONG_USE, "the light's position is not finite");
    for (int c = 0; c < 3; c++)
        sound &= l->power[c] >= 0 && isfinite(l->power[c]);
    if (!sound) return fail(MERLIN_WRONG_USE, "a lamp's power is below 0, or not finite");
    const float length = l->distant ? vec3_length(at) : 1;
    return length > 1e-6f && length < 1e18f ? OK : fail(MERLIN_WRONG_USE, "a lamp's direction has no length");
}

/* Converts lamps; *out is malloc'ed, NULL after a failure. */
static status take_lamps(const merlin_lamp *lamps, size_t count, lamp **out)
{
    status s = OK;
    *out = calloc(count + 1, sizeof **out);
    if (!*out) return fail(MERLIN_NO_MEMORY, "no memory for %zu lamps", count);
    for (size_t i = 0; i < count && s == OK; i++) {
        s = check_lamp(&lamps[i]);
        (*out)[i] = lamp_of(&lamps[i]);
    }
    if (s == OK) return OK;
    free(*out);
    *out = NULL;
    return s;
}

merlin_status merlin_relighting_check(merlin_relighting how, const merlin_lamp *light, int surroundings)
{
    status s = light ? check_lamp(light) : OK;
    if (s != OK) return s;
    const lamp l = light ? lamp_of(light) : lamp_at(vec3_make(0, 0, 0));
    return relighter_check(how, light ? &l : NULL, surroundings != 0);
}

static status render(merlin_relighter *st, const lamp *lamps, int count, const merlin_environment *environment,
                     merlin_image *out)
{
    status s = count || environment ? OK : fail(MERLIN_WRONG_USE, "neither a light nor an environment to relight by");
    if (s == OK && count == 0) s = relighter_check(st->relighter.how, NULL, true);
    for (int i = 0; i < count && s == OK; i++)
        s = relighter_check(st->relighter.how, &lamps[i], environment);
    if (s == OK) s = relighter_surround(&st->relighter, environment ? &environment->map : NULL);
    return s == OK ? relighter_render(st->network, &st->relighter, lamps, count, out) : s;
}

merlin_status merlin_relighter_render_lamps(merlin_relighter *st, const merlin_lamp *lamps, int count,
                                            const merlin_environment *environment, merlin_image *out)
{
    if (out) *out = (merlin_image){0};
    status s = api_needs(__func__, st && out && (lamps || count == 0));
    if (s == OK && count < 0) s = fail(MERLIN_WRONG_USE, "there are no %d lamps", count);
    lamp *taken = NULL;
    if (s == OK) s = take_lamps(lamps, (size_t)count, &taken);
    if (s == OK) s = render(st, taken, count, environment, out);
    free(taken);
    return s;
}

merlin_status merlin_relighter_render(merlin_relighter *st, const float *light, const merlin_environment *environment,
                                      merlin_image *out)
{
    const merlin_lamp place = light ? merlin_lamp_at(light[0], light[1], light[2]) : merlin_lamp_at(0, 0, 0);
    return merlin_relighter_render_lamps(st, &place, light != NULL, environment, out);
}

/* ---- pictures ---- */

merlin_status merlin_relighter_make_matte(merlin_relighter *st)
{
    status s = api_needs(__func__, st);
    return s == OK ? relighter_make_matte(&st->relighter) : s;
}

merlin_status merlin_relighter_resize(merlin_relighter *st, const merlin_maps *maps, int side)
{
    status s = api_needs(__func__, st && maps);
    if (s == OK) s = check_side(side);
    return s == OK ? relighter_resize(&st->relighter, maps, side) : s;
}

const merlin_image *merlin_relighter_mask(const merlin_relighter *st)
{
    return &st->relighter.full.mask;
}

merlin_status merlin_relighter_place(const merlin_relighter *st, const merlin_image *square, merlin_image *out)
{
    if (out) *out = (merlin_image){0};
    status s = api_needs(__func__, st && square && out);
    if (s != OK) return s;
    const img *mask = &st->relighter.full.mask;
    if (!square->data || square->channels != 3 || square->width != st->crop.side || square->height != st->crop.side ||
        mask->width != st->crop.side)
        return fail(MERLIN_WRONG_USE, "the photograph's square has %d x %d pixels, and no other picture fits it",
                    st->crop.side, st->crop.side);
    s = img_new(out, st->width, st->height, 3);
    if (s == OK) crop_put(square, st->crop, mask, out);
    return s;
}

/* ---- exposure ---- */

float merlin_relighter_white(const merlin_relighter *st)
{
    return st->relighter.white;
}

merlin_status merlin_relighter_set_white(merlin_relighter *st, float white)
{
    status s = api_needs(__func__, st);
    if (s == OK && !(white > 0 && isfinite(white)))
        s = fail(MERLIN_WRONG_USE, "white is a radiance above 0, not %g", (double)white);
    if (s == OK) st->relighter.white = white;
    return s;
}

merlin_status merlin_relighter_meter(merlin_relighter *st, const merlin_lamp *lamps, size_t count,
                                     const merlin_environment *environment, float *white)
{
    status s = api_needs(__func__, st && white && (lamps || count == 0));
    lamp *taken = NULL;
    if (s == OK) s = take_lamps(lamps, count, &taken);
    if (s == OK) s = relighter_surround(&st->relighter, environment ? &environment->map : NULL);
    if (s == OK) s = relighter_meter(&st->relighter, taken, count, white);
    free(taken);
    return s;
}

merlin_status merlin_relighter_meter_together(merlin_relighter *st, const merlin_lamp *lamps, size_t count,
                                              const merlin_environment *environment, float *white)
{
    float sum = 0;
    status s = api_needs(__func__, st && white && (lamps || count == 0));
    for (size_t i = 0; i < count && s == OK; i++) {
        float one = 0;
        s = merlin_relighter_meter(st, lamps + i, 1, NULL, &one);
        sum += one;
    }
    if (s == OK && (environment || count == 0)) {
        float around = 0;
        s = merlin_relighter_meter(st, NULL, 0, environment, &around);
        sum += around;
    }
    if (s == OK) *white = sum;
    return s;
}
