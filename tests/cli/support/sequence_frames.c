/* SPDX-License-Identifier: MIT */
/* Composes frames of a sequence from a picture of an object in the dark:
 *
 *     sequence_frames PICTURE OUT still|moving COUNT
 *
 * writes OUT/frame_0001.png and so on, 480×360, with a camera's noise, an exposure and a white balance that change from
 * frame to frame. moving: the object moves by 6 pixels to the right and 2 down a frame, over a background; OUT ending
 * in .mp4: a video instead. */
#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "merlin/merlin.h"

enum { WIDTH = 480, HEIGHT = 360, SIDE = 256, LEFT = 112, TOP = 52 };

/* Returns a normally distributed number, by the sum of twelve uniform ones. */
static double noise(void)
{
    static uint64_t state = 1;
    double sum = -6;
    for (int i = 0; i < 12; i++) {
        state = state * 6364136223846793005u + 1442695040888963407u;
        sum += (double)(state >> 40) / (double)(1 << 24);
    }
    return sum;
}

static double light_of(const merlin_image *object, int x, int y, int c, bool moving)
{
    double light = moving ? 0.01 + 0.006 * sin(0.13 * x) * sin(0.11 * y) : 0.004;
    const int u = x - LEFT, v = y - TOP;
    if (u >= 0 && v >= 0 && u < object->width && v < object->height)
        light = fmax(light, (double)object->data[((size_t)v * (size_t)object->width + (size_t)u) * 3 + (size_t)c]);
    return light;
}

static void compose(const merlin_image *object, int frame, bool moving, merlin_image *out)
{
    const double exposure = 1 + 0.12 * sin(2.1 * frame), balance = 0.03 * sin(1.3 * frame);
    const int dx = moving ? 6 * frame - 60 : 0, dy = moving ? 2 * frame - 20 : 0;
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++)
            for (int c = 0; c < 3; c++) {
                double light = light_of(object, x - dx, y - dy, c, moving) * exposure * (1 + (1 - c) * balance);
                light += noise() * sqrt(4e-4 * light + 2e-6);
                out->data[((size_t)y * WIDTH + (size_t)x) * 3 + (size_t)c] = (float)fmin(fmax(light, 0), 1);
            }
}

static void check(merlin_status s)
{
    if (s == MERLIN_OK) return;
    fprintf(stderr, "sequence_frames: %s\n", merlin_error());
    exit(1);
}

int main(int argc, char **argv)
{
    if (argc != 5) return 2;
    merlin_image whole, object, frame = {WIDTH, HEIGHT, 3, calloc((size_t)WIDTH * HEIGHT * 3, sizeof(float))};
    merlin_video *video = NULL;
    check(merlin_image_read(argv[1], &whole, NULL));
    check(merlin_image_resize(&whole, SIDE, SIDE, &object));
    merlin_image_free(&whole);
    if (file_ends_in(argv[2], ".mp4")) check(merlin_video_create(argv[2], WIDTH, HEIGHT, 25, &video));
    for (int i = 0; i < atoi(argv[4]) && frame.data; i++) {
        char name[4096];
        snprintf(name, sizeof name, "%s/frame_%04d.png", argv[2], i + 1);
        compose(&object, i, strcmp(argv[3], "moving") == 0, &frame);
        check(video ? merlin_video_add(video, &frame) : merlin_image_write(name, &frame));
    }
    if (video) check(merlin_video_finish(video, 1));
    merlin_image_free(&object);
    free(frame.data);
    return 0;
}
