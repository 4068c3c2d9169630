/* SPDX-License-Identifier: MIT */
#include "estimate/light/bounce.h"

#include "image/resize.h"

enum { FLASH, LIGHT, PLANES };
/* Radius of the surroundings whose light counts, as a fraction of the frame; docs/notes/cast_shadows.md has its effect.
 */
static const int FRAME_BY_RADIUS = 32;
static const float DARK = 1e-6f;

/* Sums the channels of the flash's light, and of the new light. */
static status brightness(const img *direct_by_flash, const img *direct, const img *ambient, img *out)
{
    status s = img_new(out, direct->width, direct->height, PLANES);
    if (s != OK) return s;
    size_t count = (size_t)direct->width * (size_t)direct->height;
    for (size_t i = 0; i < count; i++)
        for (size_t c = 3 * i; c < 3 * i + 3; c++) {
            out->data[PLANES * i + FLASH] += direct_by_flash->data[c];
            out->data[PLANES * i + LIGHT] += direct->data[c] + (ambient ? ambient->data[c] : 0);
        }
    return OK;
}

status bounce_follow(const img *direct_by_flash, const img *direct, const img *ambient, img *indirect)
{
    img sums = {0};
    status s = brightness(direct_by_flash, direct, ambient, &sums);
    if (s == OK) s = img_box_sums(&sums, sums.width / FRAME_BY_RADIUS);
    size_t count = s == OK ? (size_t)indirect->width * (size_t)indirect->height : 0;
    for (size_t i = 0; i < count; i++) {
        float flash = sums.data[PLANES * i + FLASH], light = sums.data[PLANES * i + LIGHT];
        float share = light < flash ? light / (flash + DARK) : 1;
        for (size_t c = 3 * i; c < 3 * i + 3; c++)
            indirect->data[c] *= share;
    }
    img_free(&sums);
    return s;
}
