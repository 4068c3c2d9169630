/* SPDX-License-Identifier: MIT */
/* Parts that a graph is built for, and those of its output "lights" (model.h). */
#ifndef MERLIN_MODEL_MODEL_PART_H
#define MERLIN_MODEL_MODEL_PART_H

#include "model/model_config.h"

/* Offsets of the parts of "lights". Strengths are in the photograph's radiance: 1 is that of a lamp of power
 * LIGHT_POWER at distance 1. They span orders of magnitude, hence model_encode_strength. */
enum {
    MODEL_LIGHTS_FLASH = 0,    /* the flash's strength, encoded */
    MODEL_LIGHTS_LAMP = 1,     /* direction to the strongest lamp, as long as the network is confident: 3 */
    MODEL_LIGHTS_DISTANCE = 4, /* inverse of its distance from there; 0: far away */
    MODEL_LIGHTS_STRENGTH = 5, /* its strength in the object's middle, encoded, by channel: 3 */
    MODEL_LIGHTS_REST = 8,     /* model_encode_sh of all other light: MODEL_SH */
    MODEL_LIGHTS = 8 + MODEL_SH
};

typedef enum model_part {
    MODEL_WHOLE,         /* everything that is computed once for a photograph */
    MODEL_TRAINING,      /* MODEL_WHOLE with losses */
    MODEL_TRAINING_BRDF, /* with "relight_brdf" of "relit_brdf", too, where "relight" is the network's */
    MODEL_TRAINING_SSIM, /* with "relight_ssim" and "relight_brdf_ssim", too, structural dissimilarity of both */
    MODEL_MAPS,          /* MODEL_WHOLE without what depends on a new light, but with the outputs model_features */
    MODEL_INDIRECT, /* the global-illumination network alone: inputs "direct", "albedo", "normal", "roughness", "depth",
                     * "mask", for both lights "environment"; output "indirect" */
    MODEL_RELIGHT,  /* the relighting decoder alone: inputs model_features, "mask" and "light"; output "relit_direct" */
    MODEL_FIRST,    /* the first scale alone of the network of near lights (model/nfps.h) */
    MODEL_REFINE,   /* its other scales' */
} model_part;

#endif
