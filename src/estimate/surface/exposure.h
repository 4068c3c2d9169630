/* SPDX-License-Identifier: MIT */
/* Scale from the brightness of a photograph to the radiance that the network was trained on.
 *
 * A photograph's values are relative: 1 is where it saturates, at whatever exposure the camera chose. The network was
 * trained on radiance under a flash of power 5.95 at distance about 1, photographed with a white between 1 and 2.5. A
 * photograph's white is taken to be the middle of that range, unless its bright parts (the 95th percentile of the
 * object's luminance) would then lie outside their range in the training data: a darker or brighter photograph gets the
 * gain that brings them to the nearer end, so that a small change of the photograph is a small change of the gain. */
#ifndef MERLIN_ESTIMATE_SURFACE_EXPOSURE_H
#define MERLIN_ESTIMATE_SURFACE_EXPOSURE_H

#include <stdbool.h>

#include "image/image.h"

/* The middle of the training data's whites, e^0.45 (docs/notes/white.md). */
#define EXPOSURE_WHITE 1.568f

/* Returns the radiance per value, within EXPOSURE_MOST_EV stops of EXPOSURE_WHITE, as floats may be in any unit, such
 * as candela per square metre; a black photograph gets EXPOSURE_WHITE. color: 3 channels, linear; mask: 1 channel, the
 * object from 0.5 on. */
float exposure_gain(const img *color, const img *mask);

/* Returns the radiance that becomes 1 in new pictures of a photograph's object: the photograph's own white; if it has
 * values above 1, which pictures cannot show, at least EXPOSURE_WHITE. */
float exposure_white(const img *photo, float gain);

/* Returns the radiance at which a photograph saturates: its white, or infinity if it has values above 1. */
float exposure_limit(const img *photo, float gain);

/* Returns the share of the object's values, channel by channel, that are burnt out: equal to 1, where a photograph
 * saturates. Larger values were not cut off there: they are floats, or a colour outside sRGB. color: 3 channels,
 * linear; mask: 1 channel; only fully covered pixels count, so that color may have been multiplied by it. */
float exposure_burnt_out(const img *color, const img *mask);

/* Largest exposure correction in stops. */
#define EXPOSURE_MOST_EV 20.0f
/* Returns EXPOSURE_WHITE · 2^EV. */
float exposure_from_ev(float ev);
/* Tells whether an estimate can have had this gain. */
bool exposure_is_sound(float gain);

#endif
