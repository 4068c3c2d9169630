/* SPDX-License-Identifier: MIT */
#include "image/plain/picture_plain.h"

#include <stdlib.h>
#include <sys/stat.h>

#include "base/file.h"
#include "image/plain/plain_file.h"

static const plain_format *format_of(picture_kind kind)
{
    return kind == PICTURE_PNM ? &plain_pnm : kind == PICTURE_BMP ? &plain_bmp : &plain_tga;
}

static size_t bytes_of_sample(picture_sample sample)
{
    return sample == PICTURE_UINT8 ? 1 : sample == PICTURE_UINT16 ? 2 : sizeof(float);
}

static status read_rows(plain_file *f, const plain_format *format, void *state, picture_rows *rows)
{
    const picture_layout *l = &f->layout;
    void *samples = malloc((size_t)l->width * (size_t)l->bands * bytes_of_sample(l->sample));
    status s = samples ? OK : fail(MERLIN_NO_MEMORY, "no memory to read %s", f->path);
    for (int y = 0; s == OK && y < l->height; y++) {
        s = format->row(f, state, samples) ? OK : plain_damaged(f);
        if (s == OK) picture_rows_put(rows, y, samples);
    }
    free(samples);
    return s;
}

static void drop_empty_alpha(img *alpha)
{
    for (size_t i = 0; i < img_value_count(alpha); i++)
        if (alpha->data[i] > 0) return;
    img_free(alpha);
}

static status read_open(plain_file *f, const plain_format *format, void *state, picture_colour how, img *color,
                        img *alpha)
{
    picture_rows *rows;
    status s = picture_rows_new(&f->layout, how, color, alpha, &rows);
    if (s == OK) s = read_rows(f, format, state, rows);
    picture_rows_free(rows);
    if (s == OK && alpha && alpha->data) drop_empty_alpha(alpha);
    return s;
}

status picture_read_plain(const char *path, picture_kind kind, picture_colour how, img *color, img *alpha,
                          picture_head *head)
{
    const plain_format *format = format_of(kind);
    plain_file f = {.file = file_open(path), .path = path};
    struct stat about;
    void *state = NULL;
    if (!f.file) return fail_by_errno(MERLIN_BAD_INPUT, "cannot read %s", path);
    if (fstat(fileno(f.file), &about) != 0) {
        fclose(f.file);
        return fail_by_errno(MERLIN_BAD_INPUT, "cannot read %s", path);
    }
    f.size = (uint64_t)about.st_size;
    status s = format->open(&f, &state);
    if (s == OK && color) s = read_open(&f, format, state, how, color, alpha);
    format->close(state);
    fclose(f.file);
    *head = (picture_head){
        .width = f.layout.width, .height = f.layout.height, .bits = f.bits, .plain = true, .light = f.layout.light};
    return s;
}
