/* SPDX-License-Identifier: MIT */
/* The renderer's random streams (base/rng.h): one for each purpose, so that layers do not affect each other's numbers.
 * The values are part of the data set's identity; new ones are added at the end. */
#ifndef MERLIN_LAB_RENDER_STREAMS_H
#define MERLIN_LAB_RENDER_STREAMS_H

enum {
    STREAM_JITTER = 1000, /* far from the values in src/lab/scene */
    STREAM_INDIRECT,
    STREAM_TARGET,
    STREAM_SURROUNDINGS,
    STREAM_LIGHTS,
    STREAM_ENVIRONMENT,
    STREAM_LAMPS,
    STREAM_LAMP_PLACES,
    STREAM_LENS,
    STREAM_LEDS,
    STREAM_LED_PLACES,
};

#endif
