/* SPDX-License-Identifier: MIT */
/* A photograph in the size and encoding in which its object is searched. */
#ifndef MERLIN_ESTIMATE_OBJECT_OBJECT_VIEW_H
#define MERLIN_ESTIMATE_OBJECT_OBJECT_VIEW_H

#include "estimate/object/color_mixture.h"
#include "estimate/object/grid_cut.h"
#include "image/image.h"

typedef struct object_view {
    int width, height;
    size_t count;
    img color;             /* exposed, square-root encoded, in [0, 1] */
    mixture_pixels pixels; /* the same colours, with places */
} object_view;

/* Makes the view. side: length of the longer side, at most the photograph's own. exposure: factor of the values. */
status object_view_new(const img *photo, int side, float exposure, object_view *out);
void object_view_free(object_view *v);
/* Finds the factor that brings a photograph's values to the usual range: those far above 1, or of a photograph without
 * a bright pixel. */
status object_view_exposure(const img *photo, int side, float *exposure);
/* Sets a cut's ties: `strength` between similar neighbours, hardly anything where colours change. */
void object_view_tie(const object_view *v, float strength, grid_cut *g);

#endif
