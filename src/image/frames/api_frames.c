/* SPDX-License-Identifier: MIT */
/* The frames of a video or of numbered pictures, and pictures as a video (merlin/frames.h). */
#include "merlin/frames.h"

#include <stdlib.h>
#include <string.h>

#include "base/api_needs.h"
#include "base/file.h"
#include "image/frames/numbered.h"
#include "image/read/read.h"
#include "image/video/video_read.h"
#include "image/video/video_write.h"

struct merlin_frames {
    char *path;           /* a video's, or NULL */
    img_video *video;     /* NULL: pictures */
    numbered_files files; /* pictures */
    numbered_files masks; /* masks of a folder, by number */
    char *first_mask;     /* mask of the first frame, or NULL */
    long read;            /* number of frames that were read */
    merlin_frames_head head;
};

/* ---- opening ---- */

int merlin_frames_are(const char *path)
{
    if (!path) return 0;
    return img_is_video(path) ? 1 : numbered_is_pattern(path) ? 2 : 0;
}

static status open_masks(merlin_frames *f, const char *masks)
{
    if (!masks) return OK;
    if (file_is_folder(masks)) return numbered_of_masks(masks, &f->masks);
    f->first_mask = strdup(masks);
    return f->first_mask ? file_check_plain(masks) : fail(MERLIN_NO_MEMORY, "no memory for file names");
}

/* Checks that the masks of a folder are of these pictures. */
static status check_masks(const merlin_frames *f, const char *masks)
{
    for (size_t i = 0; i < f->files.count; i++)
        if (numbered_find(&f->masks, f->files.at[i].number)) return OK;
    return !f->masks.count || f->video ? OK
                                       : fail(MERLIN_BAD_INPUT, "no mask in %s has the number of a frame, %ld to %ld",
                                              masks, f->files.at[0].number, f->files.at[f->files.count - 1].number);
}

static void count_pictures(merlin_frames *f)
{
    const numbered_file *at = f->files.at;
    f->head.count = (long)f->files.count;
    for (size_t i = 1; i < f->files.count; i++) {
        const long gap = at[i].number - at[i - 1].number - 1;
        if (gap && !f->head.missing) f->head.first_gap = at[i - 1].number + 1;
        f->head.missing += gap;
    }
}

static status open_video(merlin_frames *f, const char *path)
{
    f->path = strdup(path);
    status s = f->path ? img_video_open(path, &f->video) : fail(MERLIN_NO_MEMORY, "no memory for file names");
    if (s != OK) return s;
    const img_video_head *h = img_video_head_of(f->video);
    f->head = (merlin_frames_head){.width = h->width,
                                   .height = h->height,
                                   .video = 1,
                                   .rate = h->rate,
                                   .count = h->frames,
                                   .interlaced = h->interlaced};
    return OK;
}

static status end_opening(merlin_frames *f, const char *masks, status s, merlin_frames **out)
{
    if (s == OK) s = open_masks(f, masks);
    if (s == OK) s = check_masks(f, masks);
    if (s == OK && !f->video) count_pictures(f);
    if (s == OK)
        *out = f;
    else
        merlin_frames_close(f);
    return s;
}

merlin_status merlin_frames_open(const char *path, const char *masks, merlin_frames **out)
{
    if (out) *out = NULL;
    status s = api_needs(__func__, path && out);
    if (s != OK) return s;
    merlin_frames *f = calloc(1, sizeof *f);
    if (!f) return fail(MERLIN_NO_MEMORY, "no memory to read %s", path);
    if (numbered_is_pattern(path))
        s = numbered_of_pattern(path, &f->files);
    else if (file_is_folder(path))
        s = numbered_of_folder(path, masks, &f->files);
    else if (file_exists(path) && !img_is_video(path))
        s = fail(MERLIN_BAD_INPUT,
                 "%s is no video that is read; give a video, a folder of numbered pictures or a pattern such as "
                 "frame_%%04d.png",
                 path);
    else
        s = open_video(f, path);
    return end_opening(f, masks, s, out);
}

merlin_status merlin_frames_open_pictures(const char *const *paths, size_t count, const char *masks,
                                          merlin_frames **out)
{
    if (out) *out = NULL;
    status s = api_needs(__func__, paths && out);
    if (s != OK) return s;
    merlin_frames *f = calloc(1, sizeof *f);
    if (!f) return fail(MERLIN_NO_MEMORY, "no memory to read the frames");
    return end_opening(f, masks, numbered_of_paths(paths, count, &f->files), out);
}

const merlin_frames_head *merlin_frames_about(const merlin_frames *frames)
{
    return frames ? &frames->head : NULL;
}

/* ---- reading ---- */

static status read_picture(const numbered_file *file, merlin_frame *out)
{
    out->number = file->number;
    out->path = file->path;
    return merlin_image_read(file->path, &out->image, &out->mask);
}

/* Replaces the mask by that of a file, if there is one. */
static status read_mask(const merlin_frames *f, merlin_frame *out)
{
    const numbered_file *of_folder = numbered_find(&f->masks, out->number);
    const char *path = of_folder ? of_folder->path : f->read == 0 && f->first_mask ? f->first_mask : NULL;
    if (!path && !f->video && !f->masks.count && !f->first_mask) path = f->files.at[f->read].mask;
    if (!path) return OK;
    img_free(&out->mask);
    return img_read_mask(path, &out->mask);
}

static status check_size(merlin_frames *f, const merlin_frame *frame)
{
    const int width = frame->image.width, height = frame->image.height;
    if (f->read == 0) {
        f->head.width = width;
        f->head.height = height;
    }
    if (width != f->head.width || height != f->head.height)
        return fail(MERLIN_BAD_INPUT,
                    "%s is %d×%d pixels, the first frame %d×%d; the frames of a sequence have one size", frame->path,
                    width, height, f->head.width, f->head.height);
    if (frame->mask.data && (frame->mask.width != width || frame->mask.height != height))
        return fail(MERLIN_BAD_INPUT, "the mask of frame %ld is %d×%d pixels, the frame %d×%d; they must be equal",
                    frame->number, frame->mask.width, frame->mask.height, width, height);
    return OK;
}

merlin_status merlin_frames_next(merlin_frames *frames, merlin_frame *out)
{
    if (out) *out = (merlin_frame){.number = 0};
    status s = api_needs(__func__, frames && out);
    if (s != OK) return s;
    bool end = false;
    if (frames->video) {
        out->number = frames->read + 1;
        out->path = frames->path;
        s = img_video_next(frames->video, &out->image, &end);
    } else if ((size_t)frames->read < frames->files.count) {
        s = read_picture(&frames->files.at[frames->read], out);
    } else {
        end = true;
    }
    if (s == OK && !end) s = read_mask(frames, out);
    if (s == OK && !end) s = check_size(frames, out);
    if (s != OK || end)
        merlin_frame_free(out);
    else
        frames->read++;
    return s;
}

void merlin_frame_free(merlin_frame *frame)
{
    if (!frame) return;
    img_free(&frame->image);
    img_free(&frame->mask);
    *frame = (merlin_frame){.number = 0};
}

void merlin_frames_close(merlin_frames *frames)
{
    if (!frames) return;
    img_video_close(frames->video);
    numbered_free(&frames->files);
    numbered_free(&frames->masks);
    free(frames->first_mask);
    free(frames->path);
    free(frames);
}

/* ---- writing ---- */

struct merlin_video {
    img_video_out *out;
    status s; /* first failure */
};

merlin_status merlin_video_create(const char *path, int width, int height, double rate, merlin_video **out)
{
    if (out) *out = NULL;
    status s = api_needs(__func__, path && out);
    if (s == OK && !file_ends_in(path, ".mp4"))
        s = fail(MERLIN_WRONG_USE, "videos are written as MP4: the name %s must end in .mp4", path);
    if (s != OK) return s;
    merlin_video *v = calloc(1, sizeof *v);
    if (!v) return fail(MERLIN_NO_MEMORY, "no memory for the video %s", path);
    s = img_video_create(path, width, height, rate, &v->out);
    if (s == OK)
        *out = v;
    else
        free(v);
    return s;
}

merlin_status merlin_video_add(merlin_video *video, const merlin_image *frame)
{
    status s = api_needs(__func__, video && frame && frame->data);
    if (s == OK) s = img_video_add(video->out, frame);
    if (s != OK && video && video->s == OK) video->s = s;
    return s;
}

merlin_status merlin_video_finish(merlin_video *video, int keep)
{
    status s = api_needs(__func__, video);
    if (s != OK) return s;
    if (!keep || video->s != OK) {
        (void)img_video_finish(video->out, MERLIN_STOPPED);
        s = keep ? fail(video->s, "a frame of the video could not be written") : OK;
    } else {
        s = img_video_finish(video->out, OK);
    }
    free(video);
    return s;
}
