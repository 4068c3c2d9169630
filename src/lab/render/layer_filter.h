/* SPDX-License-Identifier: MIT */
/* Denoises path-traced layers.
 *
 * With a few paths a pixel a network would have to learn to ignore the noise. Indirect light varies slowly over a
 * surface once its albedo is divided out, so that each pixel becomes a weighted mean of its neighbours on the same
 * surface (a joint bilateral filter guided by depth and normal; Petschnigg et al. 2004), and the albedo is multiplied
 * back. */
#ifndef MERLIN_LAB_RENDER_LAYER_FILTER_H
#define MERLIN_LAB_RENDER_LAYER_FILTER_H

#include "lab/render/sample.h"

/* Filters a 3-channel layer of s in place over a disc of radius + 1 pixels, guided by the maps of s. The filter is
 * linear in the layer, and preserves zero and constants times the albedo. */
status filter_layer(const sample *s, img *layer, int radius);

#endif
