/* SPDX-License-Identifier: MIT */
#include <stdio.h>
#include <string.h>
#include <strings.h>

#include "image/exr/exr_place.h"
#include "image/formats/picture.h"
#include "image/primaries.h"

enum { NAME_SIZE = 256 };

typedef char channel_name[NAME_SIZE];

/* The layer of maps that is the photograph, multiplied by their mask. */
static const char photo_layer[] = "photo.";

/* Tells how likely a layer, "Scene.Combined.", is what its file shows, by its last name; 0: it is one of others. */
static int rank_of(const char *layer)
{
    static const char *const shown[] = {photo_layer, "combined.", "beauty.", "composite.", "rgba.", "rgb."};
    enum { SHOWN = sizeof shown / sizeof *shown };
    for (int i = 0; i < SHOWN; i++) {
        const size_t all = strlen(layer), own = strlen(shown[i]);
        if (all < own || strcasecmp(layer + all - own, shown[i]) != 0) continue;
        if (all == own || layer[all - own - 1] == '.') return SHOWN - i;
    }
    return 0;
}

/* Finds the layer with .R, .G and .B that is most likely what the file shows, the first one among equals. */
static int find_layer(const exr_file *f, channel_name names[3])
{
    const char *name;
    int best = -1;
    for (int i = 0; (name = exr_channel_name(f, i)); i++) {
        channel_name layer, own[3];
        size_t n = strlen(name);
        if (n < 3 || n >= NAME_SIZE || strcmp(name + n - 2, ".R") != 0) continue;
        snprintf(layer, NAME_SIZE, "%.*s", (int)n - 1, name);
        for (int c = 0; c < 3; c++)
            snprintf(own[c], NAME_SIZE, "%.*s%c", (int)n - 1, name, "RGB"[c]);
        const int rank = rank_of(layer);
        if (!exr_has_channel(f, own[1]) || !exr_has_channel(f, own[2]) || rank <= best) continue;
        best = rank;
        memcpy(names, own, sizeof own);
    }
    return best < 0 ? 0 : 3;
}

/* Chooses the channels of the picture and returns how many there are; 0 if there is none. */
static int choose_channels(const exr_file *f, channel_name names[3])
{
    if (exr_has_channel(f, "R") && exr_has_channel(f, "G") && exr_has_channel(f, "B")) {
        for (int c = 0; c < 3; c++)
            snprintf(names[c], NAME_SIZE, "%c", "RGB"[c]);
        return 3;
    }
    static const char *const single[] = {"Y", "mask.A", "R", "A"};
    int layers = exr_has_channel(f, "Y") ? 0 : find_layer(f, names);
    if (layers) return layers;
    if (!exr_has_channel(f, "Y") && (exr_has_channel(f, "G") || exr_has_channel(f, "B"))) return 0;
    for (size_t i = 0; i < sizeof single / sizeof *single; i++) {
        if (!exr_has_channel(f, single[i])) continue;
        snprintf(names[0], NAME_SIZE, "%s", single[i]);
        return 1;
    }
    return 0;
}

/* Mask of maps and samples, whose colour is not multiplied by it, except for the photograph. */
static const char maps_mask[] = "mask.A";

/* Finds the alpha channel, unless it is the colour itself; returns false if there is none. A layer's own comes first.
 */
static bool find_alpha(const exr_file *f, const char *colour, channel_name alpha)
{
    channel_name own;
    snprintf(own, sizeof own, "%.*sA", (int)strlen(colour) - 1, colour);
    const char *const known[] = {own, "A", maps_mask};
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        if (!exr_has_channel(f, known[i]) || strcmp(colour, known[i]) == 0) continue;
        snprintf(alpha, NAME_SIZE, "%s", known[i]);
        return true;
    }
    return false;
}

/* Divides colour by alpha: OpenEXR's colour is premultiplied by convention, while here it is the object's own, as for
 * the other formats. */
static void divide_by_alpha(const img *alpha, img *color)
{
    const float least = 1e-6f; /* below this alpha there is no object, and dividing would amplify noise */
    size_t count = img_value_count(color);
    for (size_t i = 0; i < count; i++) {
        float cover = alpha->data[i / (size_t)color->channels];
        if (cover > least && cover < 1) color->data[i] /= cover;
    }
}

/* Converts colours of other primaries to sRGB's. */
static status convert_primaries(const exr_file *f, const char *path, img *color)
{
    float xy[8];
    double m[9];
    if (color->channels != 3 || !exr_get_chromaticities(f, xy) || primaries_are_srgb(xy)) return OK;
    if (!primaries_to_srgb(xy, m))
        return fail(MERLIN_BAD_INPUT, "cannot read %s: its chromaticities are those of no colours", path);
    size_t values = img_value_count(color);
    for (size_t i = 0; i < values; i += 3) {
        const double v[3] = {color->data[i], color->data[i + 1], color->data[i + 2]};
        for (int c = 0; c < 3; c++)
            color->data[i + (size_t)c] = (float)(m[3 * c] * v[0] + m[3 * c + 1] * v[1] + m[3 * c + 2] * v[2]);
    }
    return OK;
}

static status show_frame(const exr_file *f, img *color, img *alpha)
{
    exr_frame d = exr_display(f);
    if (d.left == 0 && d.top == 0 && d.width == color->width && d.height == color->height) return OK;
    status s = exr_place(&d, color);
    return s == OK && alpha && alpha->data ? exr_place(&d, alpha) : s;
}

static status check_frame(const exr_file *f, const char *path)
{
    exr_frame d = exr_display(f);
    if (d.width < 1 || d.height < 1) return fail(MERLIN_BAD_INPUT, "cannot read %s: its display window is empty", path);
    return picture_check_sides(path, d.width, d.height);
}

/* Fails with a message about missing channels: some of R, G and B make neither a grey nor a coloured picture. */
static status refuse_channels(const exr_file *f, const char *path)
{
    for (int c = 0; c < 3; c++) {
        const char name[] = {"RGB"[c], 0};
        if (!exr_has_channel(f, name) &&
            (exr_has_channel(f, "R") || exr_has_channel(f, "G") || exr_has_channel(f, "B")))
            return fail(MERLIN_BAD_INPUT, "cannot read %s: it has no channel %s beside the others of R, G and B", path,
                        name);
    }
    return fail(MERLIN_BAD_INPUT, "cannot read %s: it has neither R, G and B nor Y, and no layer of colour", path);
}

/* Opens the first part that has a picture. */
static status open_picture(const char *path, exr_file **out, channel_name names[3], int *channels)
{
    exr_file *f = NULL;
    bool found = true;
    status s = exr_open(path, &f);
    while (s == OK && (*channels = choose_channels(f, names)) == 0 && found)
        s = exr_next_part(f, &found);
    if (s == OK && *channels == 0) s = refuse_channels(f, path);
    if (s == OK) s = check_frame(f, path);
    if (s == OK)
        *out = f;
    else
        exr_close(f);
    return s;
}

static status read_channels(exr_file *f, channel_name names[3], int channels, img *color, img *alpha)
{
    channel_name opacity = "";
    status s = img_new(color, exr_width(f), exr_height(f), channels);
    if (s == OK && alpha && find_alpha(f, names[0], opacity)) s = img_new(alpha, exr_width(f), exr_height(f), 1);
    if (s != OK) return s;
    exr_target targets[4];
    for (int c = 0; c < channels; c++)
        targets[c] = (exr_target){names[c], color->data + c, channels};
    if (alpha && alpha->data) targets[channels++] = (exr_target){opacity, alpha->data, 1};
    s = exr_read(f, targets, (size_t)channels);
    const bool multiplied = strcmp(opacity, maps_mask) != 0 || strncmp(names[0], photo_layer, strlen(photo_layer)) == 0;
    if (s == OK && alpha && alpha->data && multiplied) divide_by_alpha(alpha, color);
    return s;
}

status picture_look_exr(const char *path, picture_head *head)
{
    exr_file *f = NULL;
    channel_name names[3];
    int channels;
    status s = open_picture(path, &f, names, &channels);
    if (s != OK) return s;
    exr_frame d = exr_display(f);
    *head = (picture_head){.width = (int)d.width, .height = (int)d.height, .bits = 32};
    exr_close(f);
    return OK;
}

status picture_read_exr(const char *path, picture_colour how, img *color, img *alpha)
{
    exr_file *f = NULL;
    channel_name names[3];
    int channels;
    status s = open_picture(path, &f, names, &channels);
    if (s != OK) return s;
    s = read_channels(f, names, channels, color, alpha);
    if (s == OK && how == PICTURE_LINEARIZE) s = convert_primaries(f, path, color);
    if (s == OK) s = show_frame(f, color, alpha);
    exr_close(f);
    return s;
}
