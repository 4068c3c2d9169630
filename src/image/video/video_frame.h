/* SPDX-License-Identifier: MIT */
/* Decoded frames of a video as linear pictures. */
#ifndef MERLIN_IMAGE_VIDEO_VIDEO_FRAME_H
#define MERLIN_IMAGE_VIDEO_VIDEO_FRAME_H

#include <stdbool.h>
#include <stdint.h>

#include "image/image.h"
#include "image/video/video_library.h"

/* The way from stored to upright pixels: x' = along[0] x + down[0] y, y' = along[1] x + down[1] y, with numbers of -1,
 * 0 and 1, and a constant that makes the least of both 0. */
typedef struct video_turn {
    int along[2], down[2];
} video_turn;

typedef struct video_converter {
    int stored_width, stored_height; /* frame as stored */
    int wide, high;                  /* with square pixels, before it is turned */
    int format;                      /* AVPixelFormat as the decoder states it */
    video_turn turn;
    bool bright;
    struct SwsContext *scaler;
    uint16_t *codes; /* a frame's red, green, blue */
    size_t stride;   /* of its rows in bytes */
    float *light;    /* light of each code */
    double mix[9];   /* to sRGB's primaries */
    bool mixed;
} video_converter;

/* Prepares the conversion of frames like this one. aspect: width of a pixel by its height; turn as above. path: for
 * messages. MERLIN_BAD_INPUT for a kind of colour that is not read. */
status video_converter_new(const char *path, const AVFrame *like, double aspect, video_turn turn, video_converter *out);
/* Tells whether it converts this frame, too. */
bool video_converter_suits(const video_converter *c, const AVFrame *frame);
status video_converter_run(const video_converter *c, const AVFrame *frame, img *out);
void video_converter_free(video_converter *c);

/* Returns the way upright by a container's matrix of nine numbers, or as it is stored for NULL; false if it is no
 * quarter turn or reflection. */
bool video_turn_of(const int32_t *matrix, video_turn *out);
/* Computes the size with square pixels; false if it is beyond what is read. */
bool video_square(int width, int height, double aspect, int *wide, int *high);

#endif
