/* SPDX-License-Identifier: MIT */
/* Shape finer than what the network resolves at its own size.
 *
 *     network_estimate(n, &low_photo, &low_mask, views, stop, &low);       at NETWORK_SIZE
 *     detail_request r = {&crop_photo, &crop_mask, gain, detail_side(size, crop.side), detail_views(views), stop};
 *     if (r.side > 0) s = detail_add(n, &r, &low.maps);                    now r.side wide
 *
 * The network was trained on objects in NETWORK_SIZE pixels. In a larger picture it estimates fine shape equally well,
 * but not coarse shape, as the object is larger than in training. Therefore coarse shape, and all of albedo, roughness
 * and depth, come from the picture of its own size, and structures of normals finer than sixteen pixels from a larger
 * one. */
#ifndef MERLIN_ESTIMATE_PHOTO_DETAIL_H
#define MERLIN_ESTIMATE_PHOTO_DETAIL_H

#include "estimate/photo/network.h"

typedef struct detail_request {
    const img *photo, *mask; /* the crop as photographed: linear, and its coverage */
    float gain;              /* factor from its values to radiance */
    const sight *how;        /* as for network_normals */
    int side, views;
    int (*stop)(void);
} detail_request;

/* Returns the side of the larger picture for a requested size: at most the crop's, as interpolation adds no detail. 0
 * if there is nothing to gain beyond NETWORK_SIZE. */
int detail_side(int size, int crop_side);

/* Returns the number of views of the larger picture: half of those requested, as two give nine tenths of the gain of
 * four. */
int detail_views(int views);

/* Resizes maps, the network's estimate from the picture of its own size, to the larger one and adds the detail. They
 * are unchanged on failure. */
status detail_add(network *n, const detail_request *r, surface *maps);

/* Adds the fine structures of `fine` to normal (3 channels, mask's size), whose coarse structures are right. The result
 * is a sum, not unit. mask: 0 or 1. */
status detail_fuse(const img *fine, const img *mask, img *normal);

#endif
