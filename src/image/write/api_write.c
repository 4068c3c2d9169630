/* SPDX-License-Identifier: MIT */
/* merlin_image_write (merlin/image.h). */
#include "base/api_needs.h"
#include "base/file.h"
#include "image/write/write.h"

merlin_status merlin_image_write(const char *path, const merlin_image *image)
{
    status s = api_needs(__func__, path && image);
    if (s != OK) return s;
    if (!image->data || image->width < 1 || image->height < 1)
        return fail(MERLIN_WRONG_USE, "cannot write %s: the image has no pixels", path);
    s = img_check_numbers(image);
    if (s != OK) return fail_in(s, "cannot write %s", path);
    if (file_ends_in(path, ".jpg") || file_ends_in(path, ".jpeg")) return img_write_picture(path, image, IMG_JPEG);
    if (file_ends_in(path, ".png")) return img_write_png(path, image, IMG_SRGB8);
    return fail(MERLIN_WRONG_USE, "cannot write %s: let its name end in .png or .jpg", path);
}
