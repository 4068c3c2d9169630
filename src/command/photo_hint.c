/* SPDX-License-Identifier: MIT */
#include "command/photo_hint.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>

/* Reads non-negative integers separated by commas, and nothing else. */
static bool read_numbers(const char *text, int *out, int count)
{
    for (int i = 0; i < count; i++) {
        char *end;
        if (*text < '0' || *text > '9') return false;
        long value = strtol(text, &end, 10);
        if (value > INT_MAX || *end != (i + 1 < count ? ',' : 0)) return false;
        out[i] = (int)value;
        text = end + 1;
    }
    return true;
}

status photo_take_point(const char *text, void *into)
{
    merlin_hint *hint = into;
    int at[2];
    if (!read_numbers(text, at, 2))
        return fail(MERLIN_WRONG_USE, "--point wants X,Y, whole pixels from the upper left corner, not \"%s\"", text);
    if (hint->point_count == MERLIN_MOST_POINTS)
        return fail(MERLIN_WRONG_USE, "at most %d times --point", MERLIN_MOST_POINTS);
    hint->point[hint->point_count].x = at[0];
    hint->point[hint->point_count++].y = at[1];
    return OK;
}

status photo_take_box(const char *text, void *into)
{
    merlin_hint *hint = into;
    int at[4];
    if (!read_numbers(text, at, 4) || at[2] == 0 || at[3] == 0)
        return fail(MERLIN_WRONG_USE,
                    "--box wants X,Y,WIDTH,HEIGHT, whole pixels from the upper left corner and at least one a side, "
                    "not \"%s\"",
                    text);
    hint->box.x = at[0];
    hint->box.y = at[1];
    hint->box.width = at[2];
    hint->box.height = at[3];
    return OK;
}

bool photo_hint_given(const merlin_hint *hint)
{
    return hint->point_count > 0 || hint->box.width > 0;
}

status photo_check_hint(const merlin_hint *hint, const char *mask, bool several)
{
    if (!photo_hint_given(hint)) return OK;
    if (mask)
        return fail(MERLIN_WRONG_USE, "--mask says where the object is; --point and --box are for the search for it");
    if (several) return fail(MERLIN_WRONG_USE, "--point and --box are of one photograph, not of several");
    return OK;
}
