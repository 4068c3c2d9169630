/* SPDX-License-Identifier: MIT */
/* Takes the grain out of path-traced layers.
 *
 * A few paths a pixel leave noise that a network would have to learn to ignore. Indirect light varies slowly over a
 * surface once its albedo is divided out, so each pixel becomes a weighted mean of its neighbours on the same surface
 * (a joint bilateral filter guided by depth and normal; Petschnigg et al. 2004), and the albedo is multiplied back. */
#ifndef MERLIN_LAB_RENDER_LAYER_FILTER_H
#define MERLIN_LAB_RENDER_LAYER_FILTER_H

#include "lab/render/sample.h"

/* Filters a 3-channel layer of s in place over a disc of radius + 1 pixels; the maps of s are its guides. The filter is
 * linear in the layer, keeps zero zero and a constant times the albedo as it is. */
status filter_layer(const sample *s, img *layer, int radius);

#endif
