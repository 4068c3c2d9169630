/* SPDX-License-Identifier: MIT */
#include "estimate/object/find_object.h"

#include <math.h>

#include "estimate/object/object_search.h"
#include "image/resize.h"

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

/* Returns the overlap of a candidate with where the object was. */
static status overlap_with(const object_search *s, const img *before, float *overlap)
{
    img small = {0};
    status result = img_resize(before, s->view.width, s->view.height, &small);
    size_t both = 0, either = 0;
    for (size_t i = 0; result == OK && i < s->view.count; i++) {
        const bool now = s->candidate[0].object[i] != 0, was = small.data[i] >= 0.5f;
        both += now && was;
        either += now || was;
    }
    img_free(&small);
    *overlap = either ? (float)both / (float)either : 0;
    return result;
}

status find_object_again(const img *photo, const img *before, img *mask, float *overlap)
{
    *mask = (img){0};
    *overlap = 0;
    object_search s;
    status result = object_search_follow(photo, before, &s);
    if (result != OK) return result;
    result = overlap_with(&s, before, overlap);
    if (result == OK) result = object_outline(&s, &s.candidate[0], photo, mask);
    object_search_free(&s);
    return result;
}
