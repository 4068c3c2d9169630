/* SPDX-License-Identifier: MIT */
/* Reads a capture from a video: twice, as only the whole of it tells which frames to take. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "image/video/video_read.h"
#include "stereo/capture/capture_parts.h"
#include "stereo/capture/frame_choice.h"

enum { USUAL_FRAMES = 16 };

typedef struct video_reading {
    const char *path;
    watch watch;
    frame_looks looks;
    float brightest; /* value of all frames */
    img_video_head head;
    size_t chosen[PST_MOST_FRAMES], count;
    merlin_capture *into;
} video_reading;

/* Calls take for each frame until it sets *enough. pass: 0 or 1, for the progress. */
static status for_frames(video_reading *r, int pass,
                         status (*take)(video_reading *r, size_t number, img *frame, bool *enough))
{
    img_video *video;
    bool end = false;
    status s = img_video_open(r->path, &video);
    if (s != OK) return s;
    r->head = *img_video_head_of(video);
    for (size_t i = 0; s == OK && !end; i++) {
        img frame = {0};
        if (r->head.frames > 0)
            watch_tell(&r->watch, "reading", 0.5 * (pass + fmin(1, (double)i / (double)r->head.frames)));
        if (watch_stops(&r->watch)) s = fail(MERLIN_STOPPED, "stopped");
        if (s == OK) s = img_video_next(video, &frame, &end);
        if (s == OK && !end) s = take(r, i, &frame, &end);
        img_free(&frame);
    }
    img_video_close(video);
    return s;
}

static status look_at(video_reading *r, size_t number, img *frame, bool *enough)
{
    (void)number;
    *enough = false;
    for (size_t i = 0, n = img_value_count(frame); i < n; i++)
        r->brightest = fmaxf(r->brightest, frame->data[i]);
    return frame_looks_add(&r->looks, frame);
}

static status name_last(merlin_capture *c, size_t number)
{
    char name[48];
    snprintf(name, sizeof name, "frame %zu", number + 1);
    free(c->name[c->count - 1]);
    c->name[c->count - 1] = NULL;
    return pst_capture_set_name(c, (size_t)c->count - 1, name);
}

static status keep_chosen(video_reading *r, size_t number, img *frame, bool *enough)
{
    static const merlin_light unknown = {.intensity = {1, 1, 1}};
    merlin_capture *c = r->into;
    if (number != r->chosen[c->count]) return OK;
    c->width = frame->width;
    c->height = frame->height;
    c->channels = frame->channels;
    const float scale = r->brightest > 1 ? PST_FLOAT_CEILING / r->brightest : 1;
    for (size_t i = 0, n = img_value_count(frame); i < n; i++)
        frame->data[i] *= scale;
    status s = pst_capture_add(c, frame, &unknown);
    if (s == OK) s = name_last(c, number);
    *enough = (size_t)c->count == r->count;
    return s;
}

static void note_light(const video_reading *r, size_t most)
{
    if (r->count == 1 && most > 1)
        warnings_add(&r->into->noticed, "light_still",
                     "the light of this video does not change, so that one frame shows as much as all: move the lamp, "
                     "and nothing else");
    if (r->head.interlaced)
        warnings_add(&r->into->noticed, "interlaced",
                     "odd and even lines are from different times; deinterlace the video first");
}

static status choose(video_reading *r, int frames)
{
    const size_t most = frames > 0 ? (size_t)frames : USUAL_FRAMES;
    status s = frame_looks_choose(&r->looks, most, r->chosen, &r->count);
    if (s == OK) note_light(r, most);
    return s;
}

static status check(const char *path, const merlin_capture_files *options)
{
    if (options->lights || options->near_lights)
        return fail(MERLIN_WRONG_USE, "lights are listed for a folder of pictures, not for the video %s", path);
    if (options->ambient || options->linear)
        return fail(MERLIN_WRONG_USE, "an ambient picture, and linear 8-bit values, are for a folder of pictures");
    if (options->unknown_lights || options->lights_optional) return OK;
    return fail(MERLIN_WRONG_USE, "the lights of the video %s are unknown, which this method does not allow", path);
}

status pst_read_video(const char *path, const merlin_capture_files *options, merlin_capture *c)
{
    video_reading r = {.path = path, .into = c};
    r.watch = (watch){options->progress, options->progress_context, options->stop};
    status s = check(path, options);
    c->lighting = MERLIN_UNKNOWN_LIGHTS;
    c->reduced = c->frames = 1;
    c->bits = 8;
    if (s == OK) s = for_frames(&r, 0, look_at);
    if (s == OK) s = choose(&r, options->frames);
    if (s == OK) s = for_frames(&r, 1, keep_chosen);
    if (s == OK) s = pst_take_mask(options->mask, path, c);
    frame_looks_free(&r.looks);
    return s;
}
