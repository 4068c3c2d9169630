/* SPDX-License-Identifier: MIT */
/* A photometric-stereo capture: many pictures of one static object from one camera, each under one light.
 *
 *     merlin_capture c;
 *     status s = pst_capture_read("owl", &(merlin_capture_files){.lights = "owl/lights.txt"}, &c);
 *     ... solve ...
 *     pst_capture_free(&c);
 *
 * Axes are those of docs/conventions.md: x right, y up, z toward the camera; light directions point from the object to
 * the light. */
#ifndef MERLIN_STEREO_CAPTURE_CAPTURE_H
#define MERLIN_STEREO_CAPTURE_CAPTURE_H

#include <stdbool.h>
#include <stdint.h>

#include "base/skipped.h"
#include "base/vec.h"
#include "base/warnings.h"
#include "base/watch.h"
#include "image/image.h"
#include "merlin/stereo.h"
#include "optics/pinhole.h"
#include "stereo/capture/plane.h"

/* Share of full scale from which on a value counts as saturated. */
#define PST_SATURATED 0.98f

/* A capture. Pictures contain linear radiance as 16-bit numbers: value = stored / 65535 (8-bit sources and those with a
 * profile are decoded, and ambient light is subtracted; solvers divide by light intensities, so that saturation stays
 * visible at 65535). */
struct merlin_capture {
    int width, height, channels, count; /* channels 1 or 3 */
    pst_plane *picture;                 /* count, each height × width × channels */
    merlin_light *light;                /* count */
    char **name;                        /* count file names, for reports */
    merlin_lighting lighting;
    bool intensities_known;
    bool intensities_listed; /* whether they were measured, and stand for pictures as they are */
    bool lens_assumed;       /* CAMERA_FOV stands for the camera's lens, which nothing tells */
    bool about_object; /* whether positions are relative to the object; pst_place_lights converts them to the camera's
                        * space */
    bool lights_in_order; /* whether the lights' file names none of the pictures, so that they were assigned in the
                           * order of their names */
    warnings noticed;     /* warnings of the reader, which pst_doubts reports */
    pinhole camera;
    int bits;              /* bits of a value in the pictures' files: 8, 16 or 32 (floats); 0: pictures in memory */
    bool linear;           /* whether 8-bit pictures were taken to be linear */
    int reduced;           /* factor by which the first picture's sides were reduced when it was read: 1 for most */
    int frames;            /* number of frames in the first picture's file, the first of which is read: 1 for most */
    skipped_files skipped; /* files of the folder that were not read */
    img mask;              /* 1 channel; 1 on the object */
    bool mask_found;       /* whether the reader found it by brightness */
    img normal_true;       /* 3 channels, or empty: ground truth if the layout has one */
    img depth_true;        /* 1 channel, or empty */
    float focal_35mm;      /* that of the first picture's EXIF, as in merlin_shot; 0: unknown */
    float field_of_view;   /* field of view for pictures to come, as in merlin_capture_params */
    double seconds_read;   /* for reading the folder */
};

/* Reads the pictures of a folder, their lights and the mask. The lights of an .lp file are then relative to the object
 * (about_object). options NULL: defaults. */
status pst_capture_read(const char *folder, const merlin_capture_files *options, merlin_capture *out);
/* Reads these pictures, in this order, under unknown lights. */
status pst_capture_read_pictures(const char *const *pictures, size_t count, const merlin_capture_files *options,
                                 merlin_capture *out);
/* Tells whether a folder has the layout of an object of LUCES or DiLiGenT. */
bool pst_is_of_data_set(const char *folder);
enum { PST_MOST_PICTURES = 4096, PST_MOST_FRAMES = 64 }; /* the latter of a video */
/* Allocates count lights of intensity 1, names and pictures, 1 to PST_MOST_PICTURES; names and pictures are NULL. */
status pst_capture_reserve(merlin_capture *c, size_t count);
/* Copies the name of picture i. */
status pst_capture_set_name(merlin_capture *c, size_t i, const char *name);
/* Adds a picture of the capture's size and channels, clipped to [0, 1]. */
status pst_capture_add(merlin_capture *c, const img *picture, const merlin_light *light);
/* Finds the mask: pixels that are above black in some picture and, if the pictures' edge is dark, brighter than it. */
status pst_capture_find_mask(merlin_capture *c);
void pst_capture_free(merlin_capture *c);

/* Sets the camera by its horizontal field of view in degrees and its mean distance from the object. 0: unknown, which
 * leaves the present value; with near lights a camera without a field of view gets the one of the first picture's EXIF,
 * else the default of 60 degrees. */
void pst_capture_see(merlin_capture *c, float field_of_view, float distance);
/* Returns the mean distance of near lights from the camera. */
float pst_lights_reach(const merlin_capture *c);
/* Makes the lights unknown, except for their intensities, which are measured separately. */
void pst_capture_forget_lights(merlin_capture *c);

#endif
