/* SPDX-License-Identifier: MIT */
/* merlin/frames: the frames of a video or of numbered pictures, read one at a time; pictures as a video.
 *
 *     merlin_frames *frames;
 *     merlin_frame frame = {0};
 *     merlin_status s = merlin_frames_open("turn.mp4", NULL, &frames);
 *     while (s == MERLIN_OK && (s = merlin_frames_next(frames, &frame)) == MERLIN_OK && frame.image.data)
 *         use(&frame.image), merlin_frame_free(&frame);
 *     merlin_frames_close(frames);
 *
 * A video's frames are numbered from 1; a picture's number is the last one in its name without the ending. Videos are
 * read and written by FFmpeg's libraries, if they are installed. */
#ifndef MERLIN_FRAMES_H
#define MERLIN_FRAMES_H

#include <merlin/image.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct merlin_frames merlin_frames;

typedef struct merlin_frames_head {
    int width, height; /* of every frame; of pictures 0 until the first was read */
    int video;         /* 1: a video, 0: pictures */
    double rate;       /* a video's frames a second, on average; 0: unknown, as of pictures */
    long count;        /* number of frames, of a video as its file states it; 0: unknown */
    long missing;      /* pictures: how many numbers between the first and the last have none */
    long first_gap;    /* the first of these */
    int interlaced;    /* 1: odd and even lines of the video's frames are from different times */
} merlin_frames_head;

typedef struct merlin_frame {
    merlin_image image; /* 3 channels; no data: the last frame was before */
    merlin_image mask;  /* 1 channel: by its file, else the picture's alpha; no data: none was given */
    long number;
    const char *path; /* the picture's file, or the video's; valid until merlin_frames_close */
} merlin_frame;

/* Tells whether a path is a video's (1), by content, or a pattern of numbered pictures (2), such as frame_%04d.png or
 * frame_####.exr if there is no file of that name; else 0. */
int merlin_frames_are(const char *path);
/* Opens a video, a pattern, or a folder of numbered pictures whose names are equal but for the number. masks: a
 * picture, the mask of the first frame; or a folder of numbered masks, each of the frame with its number; NULL: masks
 * of pictures may lie beside them. MERLIN_BAD_INPUT for what is none of these; MERLIN_DEVICE_FAILED for a video without
 * FFmpeg's libraries. */
merlin_status merlin_frames_open(const char *path, const char *masks, merlin_frames **out);
/* Opens numbered pictures by their names, in any order. */
merlin_status merlin_frames_open_pictures(const char *const *paths, size_t count, const char *masks,
                                          merlin_frames **out);
/* Returns what is known of all frames; the pointer stays valid, and its content is completed by the first frame. */
const merlin_frames_head *merlin_frames_about(const merlin_frames *frames);
/* Reads the next frame, linear as by merlin_image_read; out->image has no data after the last. MERLIN_BAD_INPUT for
 * damaged files, and for a frame of another size than the first. */
merlin_status merlin_frames_next(merlin_frames *frames, merlin_frame *out);
void merlin_frame_free(merlin_frame *frame);
void merlin_frames_close(merlin_frames *frames);

/* ---- writing a video ---- */

typedef struct merlin_video merlin_video;

/* Begins an MP4 of 8-bit frames, in H.264 if there is an encoder for it, else MPEG-4; an odd side loses a line. path
 * ends in .mp4; rate: frames a second, 0.1 to 1000. MERLIN_DEVICE_FAILED without FFmpeg's libraries. */
merlin_status merlin_video_create(const char *path, int width, int height, double rate, merlin_video **out);
/* Adds a frame of 3 channels, clamped to [0, 1]. */
merlin_status merlin_video_add(merlin_video *video, const merlin_image *frame);
/* Ends the video, which is at its place only now, and frees it. keep 0: removes what was written instead. */
merlin_status merlin_video_finish(merlin_video *video, int keep);

#ifdef __cplusplus
}
#endif

#endif
