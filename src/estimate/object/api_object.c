/* SPDX-License-Identifier: MIT */
/* merlin_object_find (merlin/estimate.h): which part of a photograph is the object. */
#include <math.h>

#include "base/api_needs.h"
#include "base/progress.h"
#include "estimate/object/mask.h"
#include "estimate/surface/crop.h"
#include "image/read/read.h"

enum { LEAST_SIDE = 16 };

static status check_photo(const img *photo)
{
    if (!photo->data) return fail(MERLIN_WRONG_USE, "the photograph has no pixels");
    if (photo->channels != 3) return fail(MERLIN_WRONG_USE, "a photograph has 3 channels, not %d", photo->channels);
    if (photo->width < LEAST_SIDE || photo->height < LEAST_SIDE)
        return fail(MERLIN_BAD_INPUT, "the photograph is %d×%d pixels; at least %d×%d are needed", photo->width,
                    photo->height, LEAST_SIDE, LEAST_SIDE);
    if ((size_t)photo->width * (size_t)photo->height > IMAGE_MOST_PIXELS)
        return fail(MERLIN_BAD_INPUT, "the photograph has %d×%d pixels, more than 64 million; make it smaller first",
                    photo->width, photo->height);
    size_t count = 3 * (size_t)photo->width * (size_t)photo->height;
    for (size_t i = 0; i < count; i++)
        if (!isfinite(photo->data[i])) return fail(MERLIN_BAD_INPUT, "the photograph has values that are not finite");
    return OK;
}

merlin_status merlin_object_find(const merlin_image *photo, const merlin_image *mask, const merlin_hint *hint,
                                 merlin_object *out)
{
    if (out) *out = (merlin_object){0};
    status s = api_needs(__func__, photo && out);
    if (s != OK) return s;
    const double began = clock_seconds();
    mask_choice choice = {0};
    crop_square square;
    s = check_photo(photo);
    if (s == OK) s = mask_choose(photo, mask, hint, &out->mask, &choice);
    if (s == OK) s = crop_around(&out->mask, &square);
    if (s != OK) {
        merlin_object_free(out);
        return s;
    }
    out->source = choice.found ? MERLIN_MASK_FOUND : MERLIN_MASK_GIVEN;
    out->confidence = choice.confidence;
    out->seconds = clock_seconds() - began;
    return MERLIN_OK;
}

void merlin_object_free(merlin_object *object)
{
    if (!object) return;
    img_free(&object->mask);
    *object = (merlin_object){0};
}
