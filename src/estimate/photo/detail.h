/* SPDX-License-Identifier: MIT */
/* Shape finer than the network's own size shows.
 *
 *     network_estimate(n, &low_photo, &low_mask, views, stop, &low);       at NETWORK_SIZE
 *     detail_request r = {&crop_photo, &crop_mask, gain, detail_side(size, crop.side), detail_views(views), stop};
 *     if (r.side > 0) s = detail_add(n, &r, &low.maps);                    now r.side wide
 *
 * The network was trained on objects in NETWORK_SIZE pixels. In more pixels it sees what is fine as well as there, but
 * not what is coarse: an object is then larger than any it knows. So coarse shape, and all of albedo, roughness and
 * depth, are from the picture of its own size, and what is finer than sixteen pixels of a larger one in its normals. */
#ifndef MERLIN_ESTIMATE_PHOTO_DETAIL_H
#define MERLIN_ESTIMATE_PHOTO_DETAIL_H

#include "estimate/photo/network.h"

typedef struct detail_request {
    const img *photo, *mask; /* the crop, as photographed: linear, and coverage */
    float gain;              /* from its values to radiance */
    const sight *how;        /* as for network_normals, all of these */
    int side, views;
    int (*stop)(void);
} detail_request;

/* The side of the larger picture when `size` is asked for: no larger than the crop, because what is interpolated has
 * nothing finer to show. 0 where there is nothing to see beyond NETWORK_SIZE. */
int detail_side(int size, int crop_side);

/* Of the larger picture, when `views` are asked for: half of them. Two keep nine tenths of what four gain. */
int detail_views(int views);

/* maps: what the network says of the picture of its own size; brought to the larger one here. They stay as they are on
 * failure. */
status detail_add(network *n, const detail_request *r, surface *maps);

/* normal (3 channels, mask's size, what is coarse right) gets what is finer in fine, of the same size. Sums, not unit.
 * mask: 0 or 1. */
status detail_fuse(const img *fine, const img *mask, img *normal);

#endif
