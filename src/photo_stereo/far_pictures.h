/* SPDX-License-Identifier: MIT */
/* Pictures of a capture that moved too far to be aligned. */
#ifndef MERLIN_PHOTO_STEREO_FAR_PICTURES_H
#define MERLIN_PHOTO_STEREO_FAR_PICTURES_H

#include "photo_stereo/picture_edges.h"

/* MERLIN_BAD_INPUT if a picture plainly moved further than a twentieth of the longer side, up to a quarter, from where
 * the others have the object, or, if all moved, two of them from each other by more than an eighth. *by: one for each
 * picture, zeros; then the shifts that a search from zero would not find, in pixels of far_pictures_side. */
status far_pictures_refuse(const merlin_capture *c, shift *by);

/* The longer side of the pictures of edges in which these shifts are found. */
int far_pictures_side(const merlin_capture *c);

#endif
