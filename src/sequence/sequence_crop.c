/* SPDX-License-Identifier: MIT */
#include "sequence/sequence_crop.h"

#include <math.h>

/* Limits of the distance between average and square in use, as shares of its side: less is nothing that the network
 * sees, more would cost resolution. */
static const float MOST_ASIDE = 0.015f, MOST_LARGER = 0.04f;
/* A frame that is seen whole is still while the object is at least as long as this share of it. */
static const float LEAST_OF_WHOLE = 0.5f;

static void use(sequence_crop *c, crop_square square)
{
    *c = (sequence_crop){.begun = true,
                         .x = (float)square.x + 0.5f * (float)square.side,
                         .y = (float)square.y + 0.5f * (float)square.side,
                         .side = (float)square.side,
                         .held = square};
}

static bool is_whole(const img *mask, crop_square c)
{
    return c.x == 0 && c.y == 0 && c.side == mask->width && c.side == mask->height;
}

static crop_square average(const sequence_crop *c)
{
    const int side = (int)ceilf(c->side);
    return (crop_square){(int)roundf(c->x - 0.5f * (float)side), (int)roundf(c->y - 0.5f * (float)side), side};
}

status sequence_crop_next(sequence_crop *c, const img *mask, sequence_shift shift, float share)
{
    crop_square own;
    status s = crop_around(mask, &own);
    if (s != OK) return s;
    if (!c->begun) {
        use(c, own);
        return OK;
    }
    if (is_whole(mask, c->held) && crop_holds(mask, c->held, 0, LEAST_OF_WHOLE)) return OK;
    if (is_whole(mask, c->held) || is_whole(mask, own)) {
        use(c, own);
        return OK;
    }
    c->held.x += shift.x;
    c->held.y += shift.y;
    c->x += (float)shift.x + share * ((float)own.x + 0.5f * (float)own.side - c->x - (float)shift.x);
    c->y += (float)shift.y + share * ((float)own.y + 0.5f * (float)own.side - c->y - (float)shift.y);
    c->side += share * ((float)own.side - c->side);
    const float held = (float)c->held.side;
    const float aside =
        fmaxf(fabsf(c->x - (float)c->held.x - 0.5f * held), fabsf(c->y - (float)c->held.y - 0.5f * held));
    if (aside > MOST_ASIDE * held || fabsf(c->side - held) > MOST_LARGER * held) c->held = average(c);
    if (!crop_holds(mask, c->held, 0, 0)) use(c, own);
    return OK;
}
