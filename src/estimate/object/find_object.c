/* SPDX-License-Identifier: MIT */
#include "estimate/object/find_object.h"

#include <math.h>

#include "estimate/object/object_search.h"

status find_object(const img *photo, const merlin_hint *hint, img *mask, float *confidence)
{
    *mask = (img){0};
    *confidence = 0;
    object_search s;
    status result = object_search_run(photo, hint, &s);
    if (result != OK) return result;
    const object_candidate *best = &s.candidate[s.best];
    *confidence = 1 / (1 + expf(-best->quality));
    if (!(best->quality > -INFINITY))
        result =
            fail(MERLIN_BAD_INPUT, "no object stands out from the background; give a mask, or say where it is by a "
                                   "point or a box");
    if (result == OK) result = object_outline(&s, best, photo, mask);
    object_search_free(&s);
    return result;
}
