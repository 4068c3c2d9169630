#include "estimate/mask.h"

#include "estimate/find_object.h"

static const float NOTHING = 0.05f, EVERYTHING = 0.95f;

bool mask_is_opaque(const img *mask)
{
    size_t count = (size_t)mask->width * (size_t)mask->height;
    for (size_t i = 0; i < count; i++)
        if (!(mask->data[i] > EVERYTHING)) return false;
    return true;
}

bool mask_is_transparent(const img *mask)
{
    size_t count = (size_t)mask->width * (size_t)mask->height;
    for (size_t i = 0; i < count; i++)
        if (mask->data[i] >= 0.5f) return false;
    return true;
}

void mask_clean(img *mask)
{
    size_t count = (size_t)mask->width * (size_t)mask->height;
    for (size_t i = 0; i < count; i++) {
        float m = mask->data[i];
        mask->data[i] = m > EVERYTHING ? 1 : m >= NOTHING ? m : 0;
    }
}

status mask_choose(const img *photo, const img *given, img *mask, mask_choice *choice)
{
    *mask = (img){0};
    *choice = (mask_choice){false, 1};
    if (given && !given->data) given = NULL;
    if (given && (given->width != photo->width || given->height != photo->height))
        return fail(ERROR_INPUT, "the mask is %d×%d pixels, the photograph %d×%d; they must be equal", given->width,
                    given->height, photo->width, photo->height);
    if (given && given->channels != 1)
        return fail(ERROR_USAGE, "the mask has %d channels instead of 1", given->channels);
    status s;
    if (given) {
        s = img_copy(mask, given);
    } else {
        choice->found = true;
        s = find_object(photo, mask, &choice->confidence);
    }
    if (s == OK) mask_clean(mask);
    return s;
}
