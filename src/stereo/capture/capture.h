/* SPDX-License-Identifier: MIT */
/* A photometric-stereo capture: many pictures of one still object from one camera, each under one light.
 *
 *     merlin_capture c;
 *     status s = pst_capture_read("owl", &(merlin_capture_files){.lights = "owl/lights.txt"}, &c);
 *     ... solve ...
 *     pst_capture_free(&c);
 *
 * Space as everywhere: x right, y up, z toward the camera; light directions point from the object to the light. */
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

/* A value from here on, as a share of full scale, may be less than the light was. */
#define PST_SATURATED 0.98f

/* Pictures hold linear radiance as 16-bit numbers: value = stored / 65535 (8-bit sources and those with a profile
 * decoded, ambient subtracted; division by light intensities is left to the solvers so that saturation stays visible at
 * 65535). */
struct merlin_capture {
    int width, height, channels, count; /* channels 1 or 3 */
    uint16_t **picture;                 /* count planes of height × width × channels */
    merlin_light *light;                /* count */
    char **name;                        /* count file names, for reports */
    merlin_lighting lighting;
    bool intensities_known;
    bool about_object;    /* what the positions are, until pst_place_lights brings them into the camera's space */
    bool lights_in_order; /* the lights' file names none of the pictures: they were taken in the order of their names */
    warnings noticed;     /* by whoever read it: pst_doubts passes them on */
    pinhole camera;
    int bits;              /* of a value in the pictures' files: 8, 16 or 32 (floats); 0: of pictures in memory */
    bool linear;           /* those of 8 bits were taken for linear */
    int reduced;           /* so many of the first picture's pixels a side became one: 1 for most */
    int frames;            /* of an animation in the first picture's file, whose first is read: 1 for most */
    skipped_files skipped; /* of the folder */
    img mask;              /* 1 channel; 1 on the object */
    img normal_true;       /* 3, or empty: ground truth where the layout has one */
    img depth_true;        /* 1, or empty */
    float field_of_view;   /* of pictures to come, as merlin_capture_params has it */
};

/* Reads the pictures of a folder, their lights and the mask. The lights of an .lp file are about the object afterwards
 * (about_object). options NULL: the usual case. */
status pst_capture_read(const char *folder, const merlin_capture_files *options, merlin_capture *out);
/* Whether a folder is laid out as an object of LUCES or DiLiGenT. */
bool pst_is_of_data_set(const char *folder);
enum { PST_MOST_PICTURES = 4096 };
/* Room for count lights of intensity 1, names and pictures, 1 to PST_MOST_PICTURES; names and pictures are NULL. */
status pst_capture_reserve(merlin_capture *c, size_t count);
/* Keeps the name of picture i. */
status pst_capture_set_name(merlin_capture *c, size_t i, const char *name);
/* Adds a picture, of the capture's size and channels, clipped to [0, 1]. */
status pst_capture_add(merlin_capture *c, const img *picture, const merlin_light *light);
/* The mask: pixels that are above black in some picture and, where the pictures' edge is dark, brighter than that. */
status pst_capture_find_mask(merlin_capture *c);
void pst_capture_free(merlin_capture *c);

/* Seen by a camera of this horizontal field of view in degrees, from this mean distance. 0: not known, and what is
 * known of either stays, but with near lights the camera has the project's 60 degrees if there is none. */
void pst_capture_see(merlin_capture *c, float field_of_view, float distance);
/* The lights become unknown, but for their intensities, which are measured apart. */
void pst_capture_forget_lights(merlin_capture *c);

#endif
