/* SPDX-License-Identifier: MIT */
/* Reads a capture from a folder: determines its layout and calls its readers in order. */
#include "base/file.h"
#include "image/video/video_read.h"
#include "stereo/capture/capture_parts.h"

typedef enum layout { LAYOUT_PLAIN, LAYOUT_LUCES, LAYOUT_DILIGENT } layout;

static layout layout_of(const char *folder)
{
    if (file_is_in(folder, "led_params.txt")) return LAYOUT_LUCES;
    bool named = file_is_in(folder, "filenames.txt") || !file_is_in(folder, "lights.txt");
    if (file_is_in(folder, "light_directions.txt") && named) return LAYOUT_DILIGENT;
    return LAYOUT_PLAIN;
}

bool pst_is_of_data_set(const char *folder)
{
    return layout_of(folder) != LAYOUT_PLAIN;
}

static status read_layout(layout kind, const char *folder, const merlin_capture_files *options, merlin_capture *c)
{
    if (kind == LAYOUT_DILIGENT && options->near_lights && !options->unknown_lights)
        return fail(MERLIN_WRONG_USE, "the lights of %s/light_directions.txt are no positions; give a list of these",
                    folder);
    if (kind == LAYOUT_LUCES) return pst_read_luces(folder, options, c);
    if (kind == LAYOUT_DILIGENT) return pst_read_diligent(folder, options, c);
    return pst_read_plain(folder, options, c);
}

static status read_truth(layout kind, const char *folder, merlin_capture *c)
{
    if (kind == LAYOUT_LUCES) return pst_read_luces_truth(folder, c);
    if (kind == LAYOUT_DILIGENT) return pst_read_diligent_truth(folder, c);
    return OK;
}

static status settle_camera(const merlin_capture_files *options, merlin_capture *c)
{
    pst_capture_see(c, options->field_of_view, options->distance);
    if (!(options->distance > 0) || pinhole_is_near(&c->camera)) return OK;
    return fail(MERLIN_WRONG_USE, "the object's distance is for near lights or a camera whose field of view is given");
}

/* Reads what is no folder. */
static status read_other(const char *path, const merlin_capture_files *options, merlin_capture *out)
{
    if (!img_is_video(path)) return fail(MERLIN_BAD_INPUT, "there is no folder %s with pictures in it", path);
    status s = pst_read_video(path, options, out);
    if (s == OK) s = settle_camera(options, out);
    if (s != OK) pst_capture_free(out);
    return s;
}

status pst_capture_read_pictures(const char *const *pictures, size_t count, const merlin_capture_files *options,
                                 merlin_capture *out)
{
    *out = (merlin_capture){.lighting = MERLIN_UNKNOWN_LIGHTS};
    status s = OK;
    if (options->lights || options->near_lights)
        s = fail(MERLIN_WRONG_USE, "lights are listed for a folder of pictures, not for pictures one by one");
    if (s == OK) s = pst_capture_reserve(out, count);
    for (size_t i = 0; i < count && s == OK; i++)
        s = pst_capture_set_name(out, i, pictures[i]);
    if (s == OK) s = pst_read_pictures(NULL, options, out);
    if (s == OK) s = pst_take_mask(options->mask, pictures[0], out);
    if (s == OK) s = settle_camera(options, out);
    if (s != OK) pst_capture_free(out);
    return s;
}

status pst_capture_read(const char *folder, const merlin_capture_files *options, merlin_capture *out)
{
    static const merlin_capture_files defaults = {0};
    if (!options) options = &defaults;
    *out = (merlin_capture){0};
    if (!file_is_folder(folder)) return read_other(folder, options, out);
    layout kind = options->lights ? LAYOUT_PLAIN : layout_of(folder);
    status s = read_layout(kind, folder, options, out);
    if (s == OK) s = pst_read_pictures(folder, options, out);
    if (s == OK) s = pst_read_mask(folder, options, out);
    if (s == OK) s = read_truth(kind, folder, out);
    if (s == OK) s = settle_camera(options, out);
    if (s == OK && options->unknown_lights) pst_capture_forget_lights(out);
    if (s != OK) pst_capture_free(out);
    return s;
}
