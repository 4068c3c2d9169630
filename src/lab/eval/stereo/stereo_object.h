/* SPDX-License-Identifier: MIT */
/* The objects that photometric stereo is evaluated on: a real capture with ground truth, and the one photograph of it
 * that is nearest to a flash.
 *
 *     char **path;
 *     size_t count;
 *     status s = stereo_object_list("luces", &path, &count);
 *     stereo_object o;
 *     if (s == OK) s = stereo_object_read(path[0], &o);
 *     stereo_object_free(&o);
 *     file_list_free(path, count);
 *
 * An object is a sample of merlin-lab render --targets or --leds (its targets are the capture, LEDs with their lobes,
 * its flash picture the photograph) or a folder in the LUCES or DiLiGenT layout. Either is cut to the square around the
 * object that merlin_estimate would take, and shrunk by a whole number until it is at most STEREO_OBJECT_SIDE pixels
 * wide. */
#ifndef MERLIN_LAB_EVAL_STEREO_STEREO_OBJECT_H
#define MERLIN_LAB_EVAL_STEREO_STEREO_OBJECT_H

#include "stereo/capture/capture.h"

enum { STEREO_OBJECT_SIDE = 256 };

typedef struct stereo_object {
    char name[32];
    img photo;              /* 3, linear in [0, 1] */
    merlin_capture capture; /* square, with normal_true */
    img albedo;             /* 3, the true one; empty: unknown */
} stereo_object;

/* The objects of a folder, sorted: samples, objects' folders, or the folder itself if it is an object's. Free with
 * file_list_free. */
status stereo_object_list(const char *folder, char ***path, size_t *count);
/* MERLIN_BAD_INPUT for a capture without ground truth and a sample without targets. */
status stereo_object_read(const char *path, stereo_object *out);
void stereo_object_free(stereo_object *o);

/* Returns the picture whose light is nearest to a flash. */
int stereo_object_frontal(const merlin_capture *c);
/* Makes a photograph of a capture's picture, its light as if it were white: 3 channels, linear in [0, 1]. */
status stereo_object_photo(const merlin_capture *c, int picture, img *photo);

#endif
