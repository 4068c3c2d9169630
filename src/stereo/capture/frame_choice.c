/* SPDX-License-Identifier: MIT */
#include "stereo/capture/frame_choice.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/number.h"
#include "image/color.h"
#include "image/resize.h"

enum { CELLS = 24, VALUES = CELLS * CELLS, MOST_LOOKS = 16384 };

/* Share of the brightness that one frame in ten exceeds, below which a frame is dark. */
static const float dark = 0.25f;
static const double bright = 0.9;
/* Least distance of a look from those chosen: noise and compression differ by less. */
static const float alike = 0.02f;

/* Leaves out every second look. */
static void thin(frame_looks *l)
{
    for (size_t i = 0; 2 * i < l->count; i++) {
        memmove(l->look + i * VALUES, l->look + 2 * i * VALUES, VALUES * sizeof *l->look);
        l->level[i] = l->level[2 * i];
    }
    l->count = (l->count + 1) / 2;
    l->step *= 2;
}

static status make_room(frame_looks *l)
{
    if (l->count < l->room) return OK;
    size_t room = l->room ? 2 * l->room : 256;
    float *look = realloc(l->look, room * VALUES * sizeof *look);
    if (look) l->look = look;
    float *level = realloc(l->level, room * sizeof *level);
    if (level) l->level = level;
    if (!look || !level) return fail(MERLIN_NO_MEMORY, "no memory for %zu frames", room);
    l->room = room;
    return OK;
}

/* Writes the look of a frame; returns its mean brightness. */
static float look_at(const img *cells, float look[VALUES])
{
    double sum = 0, squares = 0;
    for (size_t i = 0; i < VALUES; i++) {
        look[i] = color_luminance(cells->data + 3 * i);
        sum += (double)look[i];
        squares += (double)look[i] * (double)look[i];
    }
    const float scale = squares > 0 ? (float)(1 / sqrt(squares)) : 0;
    for (size_t i = 0; i < VALUES; i++)
        look[i] *= scale;
    return (float)(sum / VALUES);
}

status frame_looks_add(frame_looks *l, const img *frame)
{
    img cells = {0};
    if (l->step == 0) l->step = 1;
    if (l->count == MOST_LOOKS) thin(l);
    if (l->seen++ % l->step) return OK;
    status s = make_room(l);
    if (s == OK) s = img_resize(frame, CELLS, CELLS, &cells);
    if (s != OK) return s;
    l->level[l->count] = look_at(&cells, l->look + l->count * VALUES);
    l->count++;
    img_free(&cells);
    return OK;
}

static float distance(const frame_looks *l, size_t i, size_t k)
{
    const float *a = l->look + i * VALUES, *b = l->look + k * VALUES;
    float sum = 0;
    for (size_t v = 0; v < VALUES; v++)
        sum += (a[v] - b[v]) * (a[v] - b[v]);
    return sqrtf(sum);
}

/* Finds the brightness that one frame in ten exceeds; sorted: room for count values. */
static float bright_level(const frame_looks *l, float *sorted)
{
    memcpy(sorted, l->level, l->count * sizeof *sorted);
    qsort(sorted, l->count, sizeof *sorted, number_ascending);
    return sorted[(size_t)(bright * (double)(l->count - 1))];
}

static size_t nearest_in_level(const frame_looks *l, float level)
{
    size_t best = 0;
    for (size_t i = 1; i < l->count; i++)
        if (fabsf(l->level[i] - level) < fabsf(l->level[best] - level)) best = i;
    return best;
}

static size_t largest(const float *values, size_t count)
{
    size_t best = 0;
    for (size_t i = 1; i < count; i++)
        if (values[i] > values[best]) best = i;
    return best;
}

static int ascending(const void *a, const void *b)
{
    const size_t x = *(const size_t *)a, y = *(const size_t *)b;
    return (x > y) - (x < y);
}

status frame_looks_choose(const frame_looks *l, size_t most, size_t chosen[], size_t *count)
{
    *count = 0;
    if (l->count == 0 || most == 0) return OK;
    float *apart = malloc(l->count * sizeof *apart);
    if (!apart) return fail(MERLIN_NO_MEMORY, "no memory for %zu frames", l->count);
    const float level = bright_level(l, apart);
    size_t next = nearest_in_level(l, level);
    for (size_t i = 0; i < l->count; i++)
        apart[i] = l->level[i] < dark * level ? 0 : 2;
    do {
        chosen[(*count)++] = next;
        for (size_t i = 0; i < l->count; i++)
            apart[i] = fminf(apart[i], distance(l, i, next));
        next = largest(apart, l->count);
    } while (*count < most && apart[next] > alike);
    free(apart);
    qsort(chosen, *count, sizeof *chosen, ascending);
    for (size_t i = 0; i < *count; i++)
        chosen[i] *= l->step;
    return OK;
}

void frame_looks_free(frame_looks *l)
{
    free(l->look);
    free(l->level);
    *l = (frame_looks){0};
}
