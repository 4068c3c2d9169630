/* SPDX-License-Identifier: MIT */
#include "image/write/jpeg.h"

#include <setjmp.h>
#include <stdio.h> /* before jpeglib.h, which needs FILE without including it */
#include <stdlib.h>

#include <jpeglib.h>

#include "image/color.h"

/* Error handler that leaves by longjmp, where the library would end the process. */
typedef struct failure {
    struct jpeg_error_mgr manager; /* first: the library only knows this member */
    jmp_buf out;
} failure;

static void leave(j_common_ptr codec)
{
    failure *f = (failure *)codec->err;
    longjmp(f->out, 1);
}

static void say_nothing(j_common_ptr codec)
{
    (void)codec;
}

static struct jpeg_error_mgr *quiet(failure *f)
{
    struct jpeg_error_mgr *m = jpeg_std_error(&f->manager);
    m->error_exit = leave;
    m->output_message = say_nothing;
    return m;
}

typedef struct bytes {
    unsigned char *data; /* malloc'ed by the library */
    unsigned long size;
} bytes;

static bool compress(uint8_t *rgb, int width, int height, const img_jpeg *how, bytes *to)
{
    struct jpeg_compress_struct c;
    failure f;
    c.err = quiet(&f);
    if (setjmp(f.out)) {
        jpeg_destroy_compress(&c);
        return false;
    }
    jpeg_create_compress(&c);
    jpeg_mem_dest(&c, &to->data, &to->size);
    c.image_width = (JDIMENSION)width;
    c.image_height = (JDIMENSION)height;
    c.input_components = 3;
    c.in_color_space = JCS_RGB;
    jpeg_set_defaults(&c);
    jpeg_set_quality(&c, how->quality, TRUE);
    c.comp_info[0].h_samp_factor = c.comp_info[0].v_samp_factor = how->halved ? 2 : 1;
    jpeg_start_compress(&c, TRUE);
    while (c.next_scanline < c.image_height) {
        JSAMPROW row = rgb + (size_t)c.next_scanline * (size_t)width * 3;
        jpeg_write_scanlines(&c, &row, 1);
    }
    jpeg_finish_compress(&c);
    jpeg_destroy_compress(&c);
    return true;
}

status jpeg_encode_codes(const char *name, uint8_t *rgb, int width, int height, const img_jpeg *how, uint8_t **data,
                         size_t *size)
{
    *data = NULL, *size = 0;
    if (width > JPEG_MAX_DIMENSION || height > JPEG_MAX_DIMENSION)
        return fail(MERLIN_WRONG_USE, "cannot write %s: a JPEG is at most %ld pixels wide and high", name,
                    (long)JPEG_MAX_DIMENSION);
    bytes made = {0};
    if (!compress(rgb, width, height, how, &made)) {
        free(made.data);
        return fail(MERLIN_NO_MEMORY, "no memory to write %s", name);
    }
    *data = made.data;
    *size = made.size;
    return OK;
}

status jpeg_encode(const char *name, const img *image, uint8_t **data, size_t *size)
{
    const img_jpeg how = {.quality = 95};
    uint8_t *rgb = malloc(img_value_count(image));
    *data = NULL, *size = 0;
    if (!rgb) return fail(MERLIN_NO_MEMORY, "no memory to write %s", name);
    srgb_codes8(image->data, img_value_count(image), rgb);
    status s = jpeg_encode_codes(name, rgb, image->width, image->height, &how, data, size);
    free(rgb);
    return s;
}

static bool decompress(const bytes *from, int width, uint8_t *rgb)
{
    struct jpeg_decompress_struct d;
    failure f;
    d.err = quiet(&f);
    if (setjmp(f.out)) {
        jpeg_destroy_decompress(&d);
        return false;
    }
    jpeg_create_decompress(&d);
    jpeg_mem_src(&d, from->data, from->size);
    jpeg_read_header(&d, TRUE);
    d.out_color_space = JCS_RGB;
    jpeg_start_decompress(&d);
    while (d.output_scanline < d.output_height) {
        JSAMPROW row = rgb + (size_t)d.output_scanline * (size_t)width * 3;
        jpeg_read_scanlines(&d, &row, 1);
    }
    jpeg_finish_decompress(&d);
    jpeg_destroy_decompress(&d);
    return true;
}

status img_jpeg_round_trip(uint8_t *rgb, int width, int height, const img_jpeg *how)
{
    bytes between = {0};
    bool done = compress(rgb, width, height, how, &between) && decompress(&between, width, rgb);
    free(between.data);
    return done ? OK : fail(MERLIN_NO_MEMORY, "cannot compress %d x %d pixels as JPEG: out of memory", width, height);
}
