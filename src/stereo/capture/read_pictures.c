/* SPDX-License-Identifier: MIT */
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "image/color.h"
#include "image/metadata/exif.h"
#include "image/read/read.h"
#include "stereo/capture/capture_parts.h"

/* Brightest value below which floats are scaled up: dim ones would become a few codes in 16 bits, and black. */
static const float FLOAT_DIM = 0.1f;

/* Number of pictures that are read in parallel, as one takes as much memory while it is read as many do afterwards. */
enum { READERS = 4 };

/* Numbers of a picture's values that are not dark, that are below the ambient picture's, and that differ from it. */
typedef struct ambient_sums {
    size_t lit, below, other;
} ambient_sums;

/* Kinds of pictures by their colours; a black one has none, as programs save it in grey. */
typedef enum picture_tone { TONE_BLACK, TONE_GREY, TONE_COLOUR } picture_tone;

typedef struct reading {
    const char *folder;
    bool decode;
    watch watch;
    float scale;                  /* factor of floats, so that all pictures fit 16 bits */
    img ambient, ambient_colours; /* the latter only beside a grey one, of which it is the colours */
    char *ambient_path;
    ambient_sums *beside; /* counts for every picture; NULL without an ambient one */
    img *first;           /* first picture, until it is stored */
    int bits;             /* its bits */
    picture_tone *tone;   /* of every picture */
    float *brightest;     /* brightest float of every picture */
    float *exposure;      /* of every picture (exif.h); 0: not known */
    bool exposures_known; /* all are, and none is absurd */
    float ambient_exposure;
    float exposure_ratio; /* of the largest known exposure to the least; 1 if that is absurd */
    merlin_capture *into;
} reading;

/* Composes a picture's path, malloc'ed; NULL without memory. */
static char *path_of(const reading *r, const char *name)
{
    return r->folder ? file_join(r->folder, name) : strdup(name);
}

/* Writes a picture's path for a message. */
static const char *told(const reading *r, const char *name, char text[PATH_MAX])
{
    snprintf(text, PATH_MAX, "%s%s%s", r->folder ? r->folder : "", r->folder ? "/" : "", name);
    return text;
}

/* Determines how the first picture is read; others of its size are read in the same way. */
static status inspect_first(const reading *r, merlin_capture *c)
{
    char *path = path_of(r, c->name[0]);
    img_facts facts = {.reduced = 1, .frames = 1};
    exif_facts shot = {0};
    status s = path ? img_look(path, &facts) : fail(MERLIN_NO_MEMORY, "no memory for a file name");
    if (s == OK) s = exif_read(path, &shot);
    c->focal_35mm = exif_focal_35mm(&shot, facts.width, facts.height);
    c->reduced = facts.reduced;
    c->frames = facts.frames;
    free(path);
    return s;
}

static status read_one(const reading *r, const char *name, img *out, int *bits)
{
    char *path = path_of(r, name);
    if (!path) return fail(MERLIN_NO_MEMORY, "no memory for a file name");
    status s = img_read_samples(path, r->decode, out, bits);
    free(path);
    return s;
}

/* Describes a kind of picture. Floats have their own unit, which is unrelated to that of integers. */
static const char *kind_of(int bits)
{
    return bits == 32 ? "floats" : "whole numbers";
}

static status check_shape(const reading *r, const merlin_capture *c, const char *name, const img *picture, int bits)
{
    char path[PATH_MAX];
    if ((bits == 32) != (r->bits == 32))
        return fail(MERLIN_BAD_INPUT, "%s has %s, but %s has %s; all pictures must be of one kind", told(r, name, path),
                    kind_of(bits), c->name[0], kind_of(r->bits));
    if (picture->width != c->width || picture->height != c->height)
        return fail(MERLIN_BAD_INPUT, "%s is %d x %d pixels, but %s is %d x %d; all pictures must have one size",
                    told(r, name, path), picture->width, picture->height, c->name[0], c->width, c->height);
    return OK;
}

/* ---- grey pictures among colour ones ---- */

/* Gives a picture colours where the capture has them. */
static status colour_as(const merlin_capture *c, img *picture)
{
    return c->channels > 1 && picture->data ? img_make_color(picture) : OK;
}

static picture_tone tone_of(const reading *r, const img *picture)
{
    if (picture->channels > 1) return TONE_COLOUR;
    for (size_t i = 0, n = img_value_count(picture); i < n; i++)
        if (picture->data[i] * r->scale >= PST_BLACK) return TONE_GREY;
    return TONE_BLACK;
}

static int count_tone(const reading *r, picture_tone tone)
{
    int count = 0;
    for (int i = 0; i < r->into->count; i++)
        count += r->tone[i] == tone;
    return count;
}

static void note_grey(const reading *r, merlin_capture *c)
{
    const int grey = count_tone(r, TONE_GREY);
    if (r->ambient_colours.data)
        warnings_add(&c->noticed, "grey_among_colour",
                     "the ambient picture %s is in colour, the others grey: its luminance is subtracted, which may be "
                     "more or less than they have of it; give all of one kind",
                     r->ambient_path);
    if (c->channels > 1 && grey > 0)
        warnings_add(
            &c->noticed, "grey_among_colour",
            "of %d pictures %d %s grey, the others in colour: normals may be degrees off, and the albedo's colours "
            "wrong; give all of one kind",
            c->count, grey, grey == 1 ? "is" : "are");
}

/* Returns the factor of the ambient picture in picture i, which may have been exposed otherwise. */
static float ambient_share(const reading *r, int i)
{
    return r->exposures_known && r->ambient_exposure > 0 ? r->exposure[i] / r->ambient_exposure : 1;
}

/* Counts values below the ambient picture's: as light only adds, clearly lower values show that it is not ambient
 * light. */
static void compare_with_ambient(const reading *r, int i, const img *picture)
{
    static const float noise = 0.02f;
    const float share = ambient_share(r, i);
    ambient_sums sums = {0};
    for (size_t k = 0, n = img_value_count(picture); k < n; k++) {
        float value = picture->data[k] * r->scale, there = share * r->ambient.data[k];
        sums.lit += value > noise || there > noise;
        sums.below += value < there - noise;
        sums.other += value != r->ambient.data[k];
    }
    r->beside[i] = sums;
}

static status store(const reading *r, int which, const img *picture, pst_plane *out)
{
    size_t count = img_value_count(picture);
    uint16_t *codes = malloc(count * sizeof *codes);
    if (!codes)
        return fail(MERLIN_NO_MEMORY, "no memory for a picture of %d x %d pixels", picture->width, picture->height);
    memory_prefer_large_pages(codes, count * sizeof *codes);
    const float *ambient = r->ambient.data, share = ambient_share(r, which);
    for (size_t i = 0; i < count; i++) {
        float value = picture->data[i] * r->scale, left = ambient ? value - share * ambient[i] : value;
        /* keeps values that the sensor clipped recognizable after the subtraction */
        float code = left * 65535 + 0.5f;
        codes[i] = value >= 1 || code >= 65535 ? 65535 : code > 0 ? (uint16_t)code : 0;
    }
    pst_plane_take(codes, count, out);
    return OK;
}

typedef struct group {
    const reading *reading;
    status (*work)(const reading *r, int i);
    int first;
} group;

static status work_on(void *context, size_t i)
{
    const group *g = context;
    return g->work(g->reading, g->first + (int)i);
}

static status for_pictures(const reading *r, status (*work)(const reading *r, int i))
{
    status s = OK;
    for (int i = 0; i < r->into->count && s == OK; i += READERS) {
        watch_tell(&r->watch, "reading", (double)i / r->into->count);
        int left = r->into->count - i;
        if (watch_stops(&r->watch)) return fail(MERLIN_STOPPED, "stopped");
        s = parallel_try((size_t)(left < READERS ? left : READERS), work_on, &(group){r, work, i});
    }
    return s;
}

static status find_brightest(const reading *r, int i)
{
    img picture;
    int bits;
    status s = read_one(r, r->into->name[i], &picture, &bits);
    if (s != OK) return s;
    for (size_t k = 0, n = img_value_count(&picture); k < n && bits == 32; k++)
        r->brightest[i] = fmaxf(r->brightest[i], picture.data[k]);
    img_free(&picture);
    return OK;
}

/* Finds the factor that brings the brightest float of all pictures to the ceiling; 1 if they fit and are not dim. */
static status measure_scale(reading *r)
{
    float most = 0;
    r->brightest = calloc((size_t)r->into->count, sizeof *r->brightest);
    if (!r->brightest) return fail(MERLIN_NO_MEMORY, "no memory for %d pictures", r->into->count);
    status s = for_pictures(r, find_brightest);
    for (int i = 0; i < r->into->count; i++)
        most = fmaxf(most, r->brightest[i]);
    free(r->brightest);
    r->scale = most > PST_FLOAT_CEILING || (most > 0 && most < FLOAT_DIM) ? PST_FLOAT_CEILING / most : 1;
    return s;
}

static status read_first_shape(reading *r, merlin_capture *c)
{
    const img *first = r->first;
    char path[PATH_MAX];
    status s = read_one(r, c->name[0], r->first, &r->bits);
    if (s != OK) return s;
    if (c->width && (c->width != first->width || c->height != first->height))
        s = fail(MERLIN_BAD_INPUT, "%s is %d x %d pixels, but the lights' file says %d x %d", told(r, c->name[0], path),
                 first->width, first->height, c->width, c->height);
    if (s == OK) s = inspect_first(r, c);
    c->width = first->width;
    c->height = first->height;
    c->channels = first->channels;
    return s == OK && r->bits == 32 ? measure_scale(r) : s;
}

/* Gives the ambient picture the channels of the others, as far as these are known: a coloured one's luminance, and its
 * colours again where some turn out to have them. */
static status ambient_as(const merlin_capture *c, reading *r)
{
    if (c->channels > 1 && r->ambient_colours.data) {
        img_free(&r->ambient);
        r->ambient = r->ambient_colours;
        r->ambient_colours = (img){0};
    }
    if (c->channels >= r->ambient.channels) return colour_as(c, &r->ambient);
    r->ambient_colours = r->ambient;
    status s = img_new(&r->ambient, c->width, c->height, 1);
    for (size_t i = 0; s == OK && i < img_value_count(&r->ambient); i++)
        r->ambient.data[i] = color_luminance(r->ambient_colours.data + 3 * i);
    return s;
}

static status read_ambient(reading *r, const char *asked, const merlin_capture *c)
{
    char *path = asked ? strdup(asked) : NULL;
    if (asked && !path) return fail(MERLIN_NO_MEMORY, "no memory for a file name");
    status s = asked || !r->folder ? OK : pst_find_ambient(r->folder, c->name[0], &path);
    int bits;
    if (path) {
        s = img_read_samples(path, r->decode, &r->ambient, &bits);
        if (s == OK && (r->ambient.width != c->width || r->ambient.height != c->height))
            s = fail(MERLIN_BAD_INPUT, "the ambient picture %s is %d x %d pixels, but the pictures are %d x %d", path,
                     r->ambient.width, r->ambient.height, c->width, c->height);
        if (s == OK && (bits == 32) != (r->bits == 32))
            s = fail(MERLIN_BAD_INPUT,
                     "the ambient picture %s has %s, but the pictures have %s; give one of their kind", path,
                     kind_of(bits), kind_of(r->bits));
        for (size_t i = 0; s == OK && i < img_value_count(&r->ambient); i++)
            r->ambient.data[i] *= r->scale;
        if (s == OK) s = ambient_as(c, r);
    }
    r->ambient_path = path;
    if (s != OK || !path) return s;
    r->beside = calloc((size_t)c->count, sizeof *r->beside);
    return r->beside ? OK : fail(MERLIN_NO_MEMORY, "no memory for %d sums", c->count);
}

/* Returns the name of the first picture whose values equal the ambient picture's, NULL if there is none; dark ones,
 * which are all similar, do not count. */
static const char *copied_as_ambient(const reading *r)
{
    for (int i = 0; i < r->into->count; i++)
        if (r->beside[i].other == 0 && r->beside[i].lit > 0) return r->into->name[i];
    return NULL;
}

/* Fails or warns if the ambient picture was taken under a light, or with another exposure, as subtracting it would
 * leave nothing. */
static status check_ambient(const reading *r, merlin_capture *c)
{
    static const double few = 0.05, all = 0.95;
    double lit = 1e-9, below = 0;
    for (int i = 0; i < c->count; i++) {
        lit += (double)r->beside[i].lit;
        below += (double)r->beside[i].below;
    }
    if (below > all * lit)
        return fail(
            MERLIN_BAD_INPUT,
            "the ambient picture %s is brighter than all pictures: it must show the object in the light that is "
            "there when no lamp is on",
            r->ambient_path);
    const char *copied = copied_as_ambient(r);
    if (copied)
        warnings_add(
            &c->noticed, "ambient_copied",
            "the ambient picture %s is the same as %s, of which nothing is left, and normals may be many degrees "
            "off: it must show the object in the light that is there when no lamp is on",
            r->ambient_path, copied);
    else if (below > few * lit)
        warnings_add(
            &c->noticed, "ambient_brighter",
            "the ambient picture %s is brighter than the pictures in %.0f %% of their values, and normals may be "
            "many degrees off: it must show the object in the light that is there when no lamp is on",
            r->ambient_path, 100 * below / lit);
    return OK;
}

/* ---- exposures ---- */

static status read_exposure(const char *path, float *out)
{
    exif_facts shot;
    status s = path ? exif_read(path, &shot) : fail(MERLIN_NO_MEMORY, "no memory for a file name");
    *out = s == OK ? shot.exposure : 0;
    return s;
}

/* Reads the exposures of all pictures and of the ambient one. No camera's differ so much as what is absurd. */
static status read_exposures(reading *r, const merlin_capture *c)
{
    static const float absurd = 1000;
    float least = HUGE_VALF, most = 0;
    bool all = true;
    status s = r->ambient_path ? read_exposure(r->ambient_path, &r->ambient_exposure) : OK;
    r->exposure = calloc((size_t)c->count, sizeof *r->exposure);
    if (!r->exposure) return fail(MERLIN_NO_MEMORY, "no memory for %d exposures", c->count);
    for (int i = 0; i < c->count && s == OK; i++) {
        char *path = path_of(r, c->name[i]);
        s = read_exposure(path, &r->exposure[i]);
        free(path);
        all &= r->exposure[i] > 0;
        if (r->exposure[i] > 0) least = fminf(least, r->exposure[i]);
        most = fmaxf(most, r->exposure[i]);
    }
    const bool sound = most > 0 && most <= absurd * least;
    r->exposure_ratio = sound ? most / least : 1;
    r->exposures_known = sound && all;
    return s;
}

static void note_unexposed(const reading *r, merlin_capture *c)
{
    char others[48] = "";
    int count = 0, first = 0;
    for (int i = c->count - 1; i >= 0; i--)
        if (!(r->exposure[i] > 0)) count++, first = i;
    if (count > 1) snprintf(others, sizeof others, " and %d more", count - 1);
    warnings_add(
        &c->noticed, "exposures_unknown",
        "by their EXIF some pictures were exposed up to %.3g times as much as others, but %s%s %s no exposure, "
        "so that nothing is evened out, and normals may be many degrees off: keep the EXIF of all, or list the "
        "strengths in light_intensities.txt",
        (double)r->exposure_ratio, c->name[first], others, count > 1 ? "have" : "has");
}

static void note_unexposed_ambient(const reading *r, merlin_capture *c)
{
    warnings_add(&c->noticed, "exposures_unknown",
                 "by their EXIF some pictures were exposed up to %.3g times as much as others, but the ambient picture "
                 "%s has no exposure, so that all of it is subtracted from each, and normals may be many degrees off: "
                 "keep its EXIF",
                 (double)r->exposure_ratio, r->ambient_path);
}

/* Takes exposures that differ for strengths of the lights: values are divided by either. */
static void even_out(const reading *r, merlin_capture *c)
{
    static const float differ = 1.02f;
    double sum = 0;
    if (!(r->exposure_ratio > differ)) return;
    if (r->exposures_known && r->ambient_path && !(r->ambient_exposure > 0)) note_unexposed_ambient(r, c);
    if (c->intensities_listed) return;
    if (!r->exposures_known) {
        note_unexposed(r, c);
        return;
    }
    for (int i = 0; i < c->count; i++)
        sum += (double)r->exposure[i];
    for (int i = 0; i < c->count; i++)
        for (int ch = 0; ch < 3; ch++)
            c->light[i].intensity[ch] = (float)((double)r->exposure[i] * c->count / sum);
    c->intensities_known = true;
    warnings_add(&c->noticed, "exposures_differ",
                 "by their EXIF some pictures were exposed up to %.3g times as much as others, which is evened out: a "
                 "fixed exposure is more exact",
                 (double)r->exposure_ratio);
}

/* ---- the whole ---- */

/* Reads a picture; the first one was read already to determine its format. */
static status get_picture(const reading *r, int i, img *out, int *bits)
{
    if (i > 0 || !r->first->data) return read_one(r, r->into->name[i], out, bits);
    *out = *r->first;
    *bits = r->bits;
    *r->first = (img){0};
    return OK;
}

/* Takes a picture, unless it has colours and the first ones have none: all are then taken again. */
static status take_picture(const reading *r, int i)
{
    img picture;
    int bits;
    status s = get_picture(r, i, &picture, &bits);
    if (s != OK) return s;
    s = check_shape(r, r->into, r->into->name[i], &picture, bits);
    r->tone[i] = tone_of(r, &picture);
    const bool fits = picture.channels <= r->into->channels;
    if (s == OK && fits) s = colour_as(r->into, &picture);
    if (s == OK && fits && r->ambient.data) compare_with_ambient(r, i, &picture);
    if (s == OK && fits) s = store(r, i, &picture, &r->into->picture[i]);
    img_free(&picture);
    return s;
}

static status take_pictures(reading *r, merlin_capture *c)
{
    r->tone = calloc((size_t)c->count, sizeof *r->tone);
    if (!r->tone) return fail(MERLIN_NO_MEMORY, "no memory for %d pictures", c->count);
    status s = for_pictures(r, take_picture);
    if (s == OK && c->channels == 1 && count_tone(r, TONE_COLOUR) > 0) {
        for (int i = 0; i < c->count; i++)
            pst_plane_free(&c->picture[i]);
        c->channels = 3;
        if (r->ambient.data) s = ambient_as(c, r);
        if (s == OK) s = for_pictures(r, take_picture);
    }
    if (s == OK) note_grey(r, c);
    free(r->tone);
    return s;
}

status pst_read_pictures(const char *folder, const merlin_capture_files *options, merlin_capture *c)
{
    img first = {0};
    reading r = {.folder = folder, .decode = !options->linear, .first = &first, .scale = 1, .into = c};
    r.watch = (watch){options->progress, options->progress_context, options->stop};
    status s = read_first_shape(&r, c);
    c->bits = r.bits;
    c->linear = options->linear != 0;
    if (s == OK) s = read_ambient(&r, options->ambient, c);
    if (s == OK) s = read_exposures(&r, c);
    if (s == OK) s = take_pictures(&r, c);
    if (s == OK && r.ambient.data) s = check_ambient(&r, c);
    if (s == OK) even_out(&r, c);
    free(r.exposure);
    img_free(&r.ambient);
    img_free(&r.ambient_colours);
    img_free(&first);
    free(r.ambient_path);
    free(r.beside);
    return s;
}
