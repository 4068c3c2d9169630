/* SPDX-License-Identifier: MIT */
/* Pictures as the frames of a video: MP4, in H.264 where an encoder for that is installed, else in MPEG-4.
 *
 *     img_video_out *v;
 *     status s = img_video_create("relit.mp4", 640, 480, 25, &v);
 *     for (int i = 0; i < count && s == OK; i++) s = img_video_add(v, &frame[i]);
 *     s = img_video_finish(v, s);
 */
#ifndef MERLIN_IMAGE_VIDEO_VIDEO_WRITE_H
#define MERLIN_IMAGE_VIDEO_VIDEO_WRITE_H

#include "image/image.h"

typedef struct img_video_out img_video_out;

/* Begins a video. path: it ends in .mp4; rate: frames a second, from 0.1 to 1000. An odd side loses a line. A file is
 * there only after img_video_finish. MERLIN_DEVICE_FAILED without FFmpeg's libraries or an encoder. */
status img_video_create(const char *path, int width, int height, double rate, img_video_out **out);
/* Adds a frame: 3 channels, linear, of that size; values are clamped to [0, 1]. */
status img_video_add(img_video_out *v, const img *frame);
/* Ends the video, or if s is a failure removes what was written, and frees v. Returns s, or what went wrong. */
status img_video_finish(img_video_out *v, status s);

#endif
