/* SPDX-License-Identifier: MIT */
/* The frames of a video, one at a time, as photographs: upright, with square pixels, linear in sRGB's primaries.
 *
 *     img_video *v;
 *     img frame;
 *     bool end = false;
 *     status s = img_video_open("turn.mp4", &v);
 *     while (s == OK && (s = img_video_next(v, &frame, &end)) == OK && !end) use(&frame), img_free(&frame);
 *     img_video_close(v);
 *
 * Codes become light by the range, matrix, curve and primaries that the stream states; television's curve, and none,
 * count as sRGB's. Where it states no matrix, it is that of BT.709 from 720 lines on, and that of BT.601 below. */
#ifndef MERLIN_IMAGE_VIDEO_VIDEO_READ_H
#define MERLIN_IMAGE_VIDEO_VIDEO_READ_H

#include <stdbool.h>

#include "image/image.h"

typedef struct img_video img_video;

typedef struct img_video_head {
    int width, height; /* of its frames, as they are returned */
    double rate;       /* frames a second, on average; 0: unknown */
    long frames;       /* about how many there are, by the file's head; 0: unknown */
    bool interlaced;   /* a frame's odd and even lines are from different times */
    bool bright;       /* a high dynamic range: values above 1 are brighter than white */
} img_video_head;

/* Tells whether a file is a video by its first bytes: MP4, QuickTime, Matroska, WebM, AVI, MPEG, Ogg, ASF, FLV, MXF or
 * YUV4MPEG2. */
bool img_is_video(const char *path);

/* Opens the file's video stream. MERLIN_BAD_INPUT if it has none, is damaged, or is of a kind or size that is not read
 * (at most 64 million pixels); MERLIN_DEVICE_FAILED without FFmpeg's libraries. */
status img_video_open(const char *path, img_video **out);
const img_video_head *img_video_head_of(const img_video *v);
/* Reads the next frame, 3 channels, which the caller frees; after the last one *end is set and the frame is empty.
 * MERLIN_BAD_INPUT where the file is damaged or cut short. */
status img_video_next(img_video *v, img *frame, bool *end);
void img_video_close(img_video *v);

#endif
