/* The brightness of a photograph against that of the training data.
 *
 * A photograph's exposure is whatever the camera chose; the training data is lit by a flash of power 5.95 at distance
 * about 1, and jittered by a stop or so. A photograph whose bright parts (the 95th percentile of the object's
 * luminance) lie within the training data's usual span is taken as it is; a darker or brighter one is multiplied by the
 * gain that brings it to the nearer end of that span, so that a small change of the photograph is a small change of the
 * gain. */
#ifndef MERLIN_ESTIMATE_EXPOSURE_H
#define MERLIN_ESTIMATE_EXPOSURE_H

#include "image/image.h"

/* color: 3 channels, linear; mask: 1 channel, the object from 0.5 on. The gain is within [1/64, 64]; 1 for a black
 * photograph. */
float exposure_gain(const img *color, const img *mask);

/* 2^EV. */
float exposure_from_ev(float ev);

#endif
