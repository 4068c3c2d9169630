/* SPDX-License-Identifier: MIT */
/* Sensor data through LibRaw: linear, so that no camera's tone curve has to be inverted. */
#include <libraw/libraw.h>

#include "base/library.h"
#include "image/formats/picture.h"
#include "image/formats/picture_dng.h"

#define LIBRAW_FUNCTIONS(USE)                                                                                          \
    USE(init)                                                                                                          \
    USE(set_dataerror_handler)                                                                                         \
    USE(open_file)                                                                                                     \
    USE(unpack)                                                                                                        \
    USE(dcraw_process)                                                                                                 \
    USE(dcraw_make_mem_image)                                                                                          \
    USE(dcraw_clear_mem)                                                                                               \
    USE(strerror)                                                                                                      \
    USE(close)

#define MEMBER(name) __typeof__(libraw_##name) *name;
#define WANTED(name) {"libraw_" #name, &raw.name},
static struct {
    LIBRAW_FUNCTIONS(MEMBER)
} raw;
static const library_function wanted[] = {LIBRAW_FUNCTIONS(WANTED)};
static library libraw = {.file = MERLIN_LIBRAW, .functions = wanted, .count = sizeof wanted / sizeof *wanted};

/* Version 0.21 has no memory callback, and so no option to disable it. */
#if LIBRAW_COMPILE_CHECK_VERSION_NOTLESS(0, 21)
enum { WITHOUT_CALLBACKS = LIBRAW_OPIONS_NO_DATAERR_CALLBACK };
#else
enum { WITHOUT_CALLBACKS = LIBRAW_OPIONS_NO_MEMERR_CALLBACK | LIBRAW_OPIONS_NO_DATAERR_CALLBACK };
#endif

static void note_damage(void *damaged, const char *file, const int offset)
{
    (void)file;
    (void)offset;
    *(bool *)damaged = true;
}

static status refusal(const char *path, int error)
{
    if (error == LIBRAW_FILE_UNSUPPORTED)
        return fail(MERLIN_BAD_INPUT,
                    "cannot read %s: the LibRaw installed here knows no such raw picture; develop it to a TIFF first",
                    path);
    if (error == LIBRAW_UNSUFFICIENT_MEMORY) return fail(MERLIN_NO_MEMORY, "no memory to read %s", path);
    if (error == LIBRAW_IO_ERROR || error == LIBRAW_DATA_ERROR)
        return fail(MERLIN_BAD_INPUT, "cannot read %s: it is damaged or cut short", path);
    return fail(MERLIN_BAD_INPUT, "cannot read %s: %s", path, raw.strerror(error));
}

/* Opens a file in a new handle, which the caller closes. */
static status open_raw(const char *path, bool *damaged, libraw_data_t **out)
{
    if (picture_tiff_is_overfull(path)) return refusal(path, LIBRAW_DATA_ERROR);
    status s = library_need(&libraw);
    if (s != OK) return s;
    libraw_data_t *file = raw.init(WITHOUT_CALLBACKS);
    if (!file) return fail(MERLIN_NO_MEMORY, "no memory to read %s", path);
    raw.set_dataerror_handler(file, note_damage, damaged);
    int error = raw.open_file(file, path);
    s = error ? refusal(path, error) : picture_check_sides(path, file->sizes.iwidth, file->sizes.iheight);
    if (s == OK)
        *out = file;
    else
        raw.close(file);
    return s;
}

/* Sets the processing. Nothing may depend on the picture's content, such as its brightest value: pictures of one set
 * share a scale. */
static void ask_for_light(libraw_output_params_t *p, bool white_balanced)
{
    const int the_cameras = 0;
    p->output_color = the_cameras;
    p->output_bps = 16;
    p->gamm[0] = p->gamm[1] = 1;
    p->no_auto_bright = 1;
    p->adjust_maximum_thr = 0;
    p->use_camera_wb = white_balanced;
}

static status develop(libraw_data_t *file, const char *path, bool white_balanced, libraw_processed_image_t **out)
{
    ask_for_light(&file->params, white_balanced);
    int error = raw.unpack(file);
    if (!error) error = raw.dcraw_process(file);
    if (!error) *out = raw.dcraw_make_mem_image(file, &error);
    if (!error && !*out) error = LIBRAW_UNSUFFICIENT_MEMORY;
    return error ? refusal(path, error) : OK;
}

/* Converts a pixel from camera colours to sRGB's primaries. In a measurement one saturated channel makes all channels
 * saturated, which mixing would hide. */
static void mix(const float (*matrix)[4], const float *seen, int colors, bool measured, float *out, int channels)
{
    float most = 0;
    for (int k = 0; k < colors; k++)
        most = seen[k] > most ? seen[k] : most;
    for (int c = 0; c < channels; c++) {
        float sum = 0;
        for (int k = 0; k < colors; k++)
            sum += (colors == 1 ? 1 : matrix[c][k]) * seen[k];
        out[c] = sum > 1 || (measured && most >= 1) ? 1 : sum > 0 ? sum : 0;
    }
}

static void take(const libraw_processed_image_t *made, const float (*matrix)[4], bool measured, img *out)
{
    const uint16_t *codes = (const void *)made->data;
    size_t colors = made->colors, channels = (size_t)out->channels;
    for (size_t i = 0, pixels = (size_t)out->width * (size_t)out->height; i < pixels; i++) {
        float seen[4];
        for (size_t k = 0; k < colors; k++)
            seen[k] = (float)codes[i * colors + k] / 65535;
        mix(matrix, seen, (int)colors, measured, out->data + i * channels, (int)channels);
    }
}

status picture_read_raw(const char *path, picture_colour how, img *color)
{
    picture_head head;
    if (picture_is_float_dng(path)) return picture_read_float_dng(path, how, color, &head);
    bool damaged = false;
    libraw_data_t *file;
    libraw_processed_image_t *made = NULL;
    status s = open_raw(path, &damaged, &file);
    if (s != OK) return s;
    s = develop(file, path, how == PICTURE_LINEARIZE, &made);
    if (s == OK && damaged) s = refusal(path, LIBRAW_DATA_ERROR);
    if (s == OK && (made->colors < 1 || made->colors > 4)) s = refusal(path, LIBRAW_FILE_UNSUPPORTED);
    if (s == OK) s = img_new(color, made->width, made->height, made->colors < 3 ? 1 : 3);
    if (s == OK) take(made, (const float(*)[4])file->color.rgb_cam, how != PICTURE_LINEARIZE, color);
    if (made) raw.dcraw_clear_mem(made);
    raw.close(file);
    return s;
}

status picture_look_raw(const char *path, picture_head *head)
{
    if (picture_is_float_dng(path)) return picture_read_float_dng(path, PICTURE_AS_IT_IS, NULL, head);
    bool damaged = false;
    libraw_data_t *file;
    status s = open_raw(path, &damaged, &file);
    if (s != OK) return s;
    *head = (picture_head){.width = file->sizes.iwidth, .height = file->sizes.iheight, .bits = 16};
    raw.close(file);
    return OK;
}
