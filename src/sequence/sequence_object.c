/* SPDX-License-Identifier: MIT */
#include "sequence/sequence_object.h"

#include <math.h>

#include "estimate/object/find_object.h"
#include "estimate/object/mask.h"
#include "image/image.h"

/* Least overlap with where it was expected of an object that was followed, and of one that was searched for. */
static const float LEAST_FOLLOWED = 0.7f, LEAST_FOUND = 0.4f;
static const float LITTLE = 0.25f; /* confidence of a mask that is a guess */

static float overlap_of(const img *one, const img *other)
{
    size_t both = 0, either = 0;
    for (size_t i = 0; i < img_value_count(one); i++) {
        const bool a = one->data[i] >= 0.5f, b = other->data[i] >= 0.5f;
        both += a && b;
        either += a || b;
    }
    return either ? (float)both / (float)either : 0;
}

/* Searches all of the frame for an object like the one that is expected. */
static status search_again(const object_request *r, merlin_object *out, merlin_frame_facts *facts)
{
    merlin_object found;
    status s = r->was_given ? MERLIN_BAD_INPUT : merlin_object_find(r->photo, NULL, NULL, &found);
    if (s == MERLIN_NO_MEMORY) return s;
    const float overlap = s == OK ? overlap_of(&found.mask, r->before) : 0;
    if (overlap >= LEAST_FOUND) {
        *out = found;
        facts->object = MERLIN_OBJECT_FOUND;
        facts->overlap = overlap;
        return OK;
    }
    if (s == OK) merlin_object_free(&found);
    facts->object = MERLIN_OBJECT_LOST;
    *out = (merlin_object){.source = MERLIN_MASK_FOUND, .confidence = LITTLE};
    return img_copy(&out->mask, r->before);
}

static status follow(const object_request *r, float *confidence, merlin_object *out, merlin_frame_facts *facts)
{
    img mask = {0};
    status s = find_object_again(r->photo, r->before, &mask, &facts->overlap);
    if (s == OK && facts->overlap >= LEAST_FOLLOWED) {
        mask_clean(&mask);
        facts->object = MERLIN_OBJECT_FOLLOWED;
        *confidence = fmaxf(*confidence, LITTLE);
        *out = (merlin_object){.mask = mask, .source = MERLIN_MASK_FOUND, .confidence = *confidence};
        return OK;
    }
    img_free(&mask);
    if (s == OK) s = search_again(r, out, facts);
    if (s == OK) *confidence = out->confidence;
    return s;
}

status sequence_object(const object_request *r, float *confidence, merlin_object *out, merlin_frame_facts *facts)
{
    facts->overlap = 1;
    const bool given = r->mask->data != NULL;
    if (!given && r->before) return follow(r, confidence, out, facts);
    status s = merlin_object_find(r->photo, given ? r->mask : NULL, r->hint, out);
    if (s != OK) return s;
    facts->object = given ? MERLIN_OBJECT_GIVEN : MERLIN_OBJECT_FOUND;
    *confidence = out->confidence;
    return OK;
}
