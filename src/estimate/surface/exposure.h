/* SPDX-License-Identifier: MIT */
/* From the brightness of a photograph to the radiance the network knows.
 *
 * A photograph's values are relative: 1 is where it saturates, at whatever exposure the camera chose. The network was
 * trained on radiance under a flash of power 5.95 at distance about 1, photographed with a white between 1 and 2.5. A
 * photograph's white is taken to be the middle of that, unless its bright parts (the 95th percentile of the object's
 * luminance) then fall outside the span they have in the training data: a darker or brighter one gets the gain that
 * brings them to the nearer end, so that a small change of the photograph is a small change of the gain. */
#ifndef MERLIN_ESTIMATE_SURFACE_EXPOSURE_H
#define MERLIN_ESTIMATE_SURFACE_EXPOSURE_H

#include <stdbool.h>

#include "image/image.h"

/* The middle of the training data's whites, e^0.45 (docs/notes/white.md). */
#define EXPOSURE_WHITE 1.568f

/* Radiance per value. color: 3 channels, linear; mask: 1 channel, the object from 0.5 on. Within EXPOSURE_MOST_EV stops
 * of EXPOSURE_WHITE, which a black photograph gets: floats may be in any unit, candela a square metre, too. */
float exposure_gain(const img *color, const img *mask);

/* The radiance that becomes 1 in new pictures of a photograph's object: the photograph's own white, unless it has
 * values above 1, for which a picture has no room; then at least EXPOSURE_WHITE. */
float exposure_white(const img *photo, float gain);

/* The share of the object's values, channel by channel, that are burnt out: at 1, where a photograph saturates. What is
 * above was not cut off there, floats or a colour beyond sRGB's. color: 3 channels, linear; mask: 1 channel; pixels
 * that it covers wholly count, so that color may have been multiplied by it. */
float exposure_burnt_out(const img *color, const img *mask);

/* Stops that may be asked for. */
#define EXPOSURE_MOST_EV 20.0f
/* EXPOSURE_WHITE · 2^EV. */
float exposure_from_ev(float ev);
/* Whether an estimate can have had this gain. */
bool exposure_is_sound(float gain);

#endif
