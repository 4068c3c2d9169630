/* SPDX-License-Identifier: MIT */
#include "image/video/video_frame.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "image/metadata/picture_light.h"
#include "image/metadata/picture_size.h"
#include "image/primaries.h"

bool video_turn_of(const int32_t *matrix, video_turn *out)
{
    const int32_t one = 1 << 16, none = 0;
    *out = (video_turn){{1, 0}, {0, 1}};
    if (!matrix) return true;
    const int32_t m[4] = {matrix[0], matrix[1], matrix[3], matrix[4]};
    int number[4];
    for (int i = 0; i < 4; i++) {
        if (m[i] != none && m[i] != one && m[i] != -one) return false;
        number[i] = m[i] / one;
    }
    *out = (video_turn){{number[0], number[1]}, {number[2], number[3]}};
    const bool straight = number[0] && number[3] && !number[1] && !number[2];
    const bool across = !number[0] && !number[3] && number[1] && number[2];
    return straight || across;
}

bool video_square(int width, int height, double aspect, int *wide, int *high)
{
    if (width < 1 || height < 1) return false;
    double w = width, h = height;
    if (aspect > 0.1 && aspect < 10) *(aspect > 1 ? &w : &h) *= aspect > 1 ? aspect : 1 / aspect;
    if (w > IMAGE_MAX_SIDE || h > IMAGE_MAX_SIDE || w * h > IMAGE_MOST_PIXELS) return false;
    *wide = (int)lround(w);
    *high = (int)lround(h);
    return true;
}

/* Finds the matrix from brightness and colour differences to colours, one of SWS_CS_*. */
static status find_matrix(const char *path, const AVFrame *f, int *matrix)
{
    enum { LINES_OF_HD = 720 };
    switch (f->colorspace) {
    case AVCOL_SPC_UNSPECIFIED:
        *matrix = f->height >= LINES_OF_HD ? SWS_CS_ITU709 : SWS_CS_ITU601;
        return OK;
    case AVCOL_SPC_RGB:
    case AVCOL_SPC_BT709:
        *matrix = SWS_CS_ITU709;
        return OK;
    case AVCOL_SPC_FCC:
        *matrix = SWS_CS_FCC;
        return OK;
    case AVCOL_SPC_BT470BG:
    case AVCOL_SPC_SMPTE170M:
        *matrix = SWS_CS_ITU601;
        return OK;
    case AVCOL_SPC_SMPTE240M:
        *matrix = SWS_CS_SMPTE240M;
        return OK;
    case AVCOL_SPC_BT2020_NCL:
        *matrix = SWS_CS_BT2020;
        return OK;
    default:
        return fail(
            MERLIN_BAD_INPUT,
            "the video %s has a colour matrix that is not read (number %d of ITU-T H.273); convert it to BT.709 "
            "first",
            path, f->colorspace);
    }
}

/* Tells whether a curve is television's: that of cameras. Screens and programs that save frames as pictures show such
 * codes as sRGB, for which telephones make them as they make their photographs. */
static bool is_television(int transfer)
{
    return transfer == AVCOL_TRC_BT709 || transfer == AVCOL_TRC_SMPTE170M || transfer == AVCOL_TRC_BT2020_10 ||
           transfer == AVCOL_TRC_BT2020_12;
}

static status find_light(const char *path, const AVFrame *f, picture_light *light)
{
    const int transfer = is_television((int)f->color_trc) ? AVCOL_TRC_IEC61966_2_1 : (int)f->color_trc;
    *light = (picture_light){.said = false};
    if (picture_light_of_cicp((int)f->color_primaries, transfer, light)) return OK;
    return fail(
        MERLIN_BAD_INPUT,
        "the video %s has a curve or primaries that are not read (numbers %d and %d of ITU-T H.273); convert it "
        "to BT.709 first",
        path, (int)f->color_trc, (int)f->color_primaries);
}

/* Tells whether codes range over all numbers: stated, or meant by names of formats that JPEG's people chose. */
static bool is_full(const AVFrame *f, bool is_rgb)
{
    const int of_jpeg[] = {AV_PIX_FMT_YUVJ420P, AV_PIX_FMT_YUVJ422P, AV_PIX_FMT_YUVJ444P, AV_PIX_FMT_YUVJ440P,
                           AV_PIX_FMT_YUVJ411P};
    for (size_t i = 0; i < sizeof of_jpeg / sizeof *of_jpeg; i++)
        if (f->format == of_jpeg[i]) return true;
    return is_rgb || f->color_range == AVCOL_RANGE_JPEG;
}

/* Returns the code that libswscale makes of white: it shifts bits rather than stretching the range. */
static double white_code(const AVPixFmtDescriptor *kind, bool is_rgb, bool full)
{
    const int bits = kind->comp[0].depth;
    const double largest = 65535, shifted = 255 * 256;
    if (!full || bits <= 8) return shifted;
    return is_rgb || bits >= 16 ? largest : (double)(((1 << bits) - 1) << (16 - bits));
}

/* Makes the table of light by code. */
static float *light_table(const picture_light *light, double white)
{
    enum { CODES = 65536 };
    float *table = malloc(CODES * sizeof *table);
    for (int i = 0; table && i < CODES; i++)
        table[i] = picture_light_of_float(light, (float)fmin(i / white, 1));
    return table;
}

static status new_scaler(const char *path, const AVFrame *f, video_converter *c)
{
    const AVPixFmtDescriptor *kind = av()->av_pix_fmt_desc_get((enum AVPixelFormat)f->format);
    if (!kind || !av()->sws_isSupportedInput((enum AVPixelFormat)f->format))
        return fail(MERLIN_BAD_INPUT, "the video %s has pixels of a kind that is not read", path);
    const bool is_rgb = (kind->flags & AV_PIX_FMT_FLAG_RGB) != 0;
    picture_light light;
    int matrix = 0;
    status s = find_matrix(path, f, &matrix);
    if (s == OK) s = find_light(path, f, &light);
    if (s != OK) return s;
    c->bright = picture_light_is_bright(&light);
    c->light = light_table(&light, white_code(kind, is_rgb, is_full(f, is_rgb)));
    c->mixed = light.has_primaries && primaries_to_srgb(light.xy, c->mix);
    c->scaler = av()->sws_getContext(
        f->width, f->height, (enum AVPixelFormat)f->format, c->wide, c->high, AV_PIX_FMT_RGB48,
        SWS_BICUBIC | SWS_FULL_CHR_H_INT | SWS_FULL_CHR_H_INP | SWS_ACCURATE_RND | SWS_BITEXACT, NULL, NULL, NULL);
    c->stride = ((size_t)c->wide * 3 * sizeof(uint16_t) + 127) / 64 * 64;
    c->codes = calloc((size_t)c->high + 1, c->stride);
    if (!c->light || !c->scaler || !c->codes) return fail(MERLIN_NO_MEMORY, "no memory for a frame of %s", path);
    const int *table = av()->sws_getCoefficients(matrix);
    const int even = 1 << 16;
    (void)av()->sws_setColorspaceDetails(c->scaler, table, is_full(f, is_rgb), table, 1, 0, even, even);
    return OK;
}

status video_converter_new(const char *path, const AVFrame *like, double aspect, video_turn turn, video_converter *out)
{
    *out = (video_converter){
        .stored_width = like->width, .stored_height = like->height, .format = like->format, .turn = turn};
    status s = OK;
    if (!video_square(like->width, like->height, aspect, &out->wide, &out->high))
        s = fail(MERLIN_BAD_INPUT, "the video %s has frames of %d×%d pixels; at most 64 million, %d a side, are read",
                 path, like->width, like->height, IMAGE_MAX_SIDE);
    if (s == OK) s = new_scaler(path, like, out);
    if (s != OK) video_converter_free(out);
    return s;
}

bool video_converter_suits(const video_converter *c, const AVFrame *frame)
{
    return frame->width == c->stored_width && frame->height == c->stored_height && frame->format == c->format;
}

/* Converts a row of codes to light, written from `to` on in steps of so many values. */
static void convert_row(const video_converter *c, const uint16_t *codes, float *to, ptrdiff_t step)
{
    for (int x = 0; x < c->wide; x++, codes += 3, to += step) {
        const float seen[3] = {c->light[codes[0]], c->light[codes[1]], c->light[codes[2]]};
        for (int k = 0; k < 3; k++) {
            float value = seen[k];
            if (c->mixed) {
                const double *m = c->mix + 3 * (ptrdiff_t)k;
                value = (float)(m[0] * (double)seen[0] + m[1] * (double)seen[1] + m[2] * (double)seen[2]);
            }
            to[k] = value > 0 ? value : 0;
        }
    }
}

status video_converter_run(const video_converter *c, const AVFrame *frame, img *out)
{
    uint8_t *rows[4] = {(uint8_t *)c->codes};
    const int strides[4] = {(int)c->stride};
    const video_turn t = c->turn;
    const bool across = t.along[0] == 0;
    status s = img_new(out, across ? c->high : c->wide, across ? c->wide : c->high, 3);
    if (s != OK) return s;
    if (av()->sws_scale(c->scaler, (const uint8_t *const *)frame->data, frame->linesize, 0, frame->height, rows,
                        strides) != c->high) {
        img_free(out);
        return fail(MERLIN_BAD_INPUT, "a frame of the video cannot be converted");
    }
    const int left = (t.along[0] < 0 ? c->wide - 1 : 0) + (t.down[0] < 0 ? c->high - 1 : 0);
    const int top = (t.along[1] < 0 ? c->wide - 1 : 0) + (t.down[1] < 0 ? c->high - 1 : 0);
    const ptrdiff_t step = 3 * ((ptrdiff_t)t.along[1] * out->width + t.along[0]);
    for (int y = 0; y < c->high; y++) {
        float *first = img_at(out, left + t.down[0] * y, top + t.down[1] * y);
        convert_row(c, (const uint16_t *)(rows[0] + (size_t)y * c->stride), first, step);
    }
    return OK;
}

void video_converter_free(video_converter *c)
{
    if (c->scaler) av()->sws_freeContext(c->scaler);
    free(c->codes);
    free(c->light);
    *c = (video_converter){0};
}
