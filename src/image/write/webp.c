/* SPDX-License-Identifier: MIT */
/* Lossless WebP, by libvips. */
#include <stdlib.h>

#include "base/file.h"
#include "image/vips_library.h"
#include "image/vips_start.h"
#include "image/write/write.h"

static int save(const uint8_t *codes, const img *image, void **data, size_t *size)
{
    size_t count = img_value_count(image);
    VipsImage *wrapped =
        vips()->image_new_from_memory(codes, count, image->width, image->height, image->channels, VIPS_FORMAT_UCHAR);
    if (!wrapped) return -1;
    int failed = vips()->webpsave_buffer(wrapped, data, size, "lossless", TRUE, NULL);
    vips()->g_object_unref(wrapped);
    return failed;
}

status img_write_webp(const char *path, const img *image)
{
    size_t count = img_value_count(image), size = 0;
    void *data = NULL;
    status s = vips_begin();
    if (s != OK) return s;
    uint8_t *codes = malloc(count);
    if (!codes) return fail(MERLIN_NO_MEMORY, "no memory to write %s", path);
    for (size_t i = 0; i < count; i++) {
        float value = image->data[i];
        codes[i] = (uint8_t)((value > 0 ? (value < 1 ? value : 1) : 0) * 255 + 0.5f);
    }
    if (save(codes, image, &data, &size))
        s = vips_refusal(MERLIN_CANNOT_WRITE, "write", path);
    else
        s = file_write(path, data, size);
    vips()->g_free(data);
    free(codes);
    return s;
}
