/* SPDX-License-Identifier: MIT */
/* From a sample to what one presentation shows the network: masks, the photograph with a camera's imperfections, the
 * target light and what it makes of the object. Everything random depends on (seed, presentation) alone. */
#ifndef MERLIN_LAB_TRAIN_PREPARE_H
#define MERLIN_LAB_TRAIN_PREPARE_H

#include "base/rng.h"
#include "base/vec.h"
#include "lab/train/dataset.h"
#include "lab/train/photograph.h"
#include "lab/train/train_config.h"

/* Streams of rng_at. */
enum {
    TRAIN_STREAM_ORDER = 101,
    TRAIN_STREAM_PRESENTATION = 102,
    TRAIN_STREAM_VALIDATION = 103,
    TRAIN_STREAM_ENVIRONMENT = 104,
    TRAIN_STREAM_MOTION = 105,
    TRAIN_STREAM_FAULTS = 106,
    TRAIN_STREAM_MIXTURE = 107
};

/* What a presentation is lit by beside the flash. */
typedef struct train_lighting {
    vec3 target; /* the target's point light */
    /* for views with environments only: */
    float strength;        /* the photograph's environment counts this much */
    float target_sh[9][3]; /* the target's environment */
} train_lighting;

/* A unpacked sample (dataset.h) to the network's inputs and targets: binary masks (mask: more than half covered, the
 * outline errors and all; loss_mask: covered wholly and not lost to an error of the outline), image encoded for the
 * network, direct clipped as the rendering layer does, reconstruction = clipped direct + indirect, relit = the BRDF
 * under light, maps to the network's ranges. The targets keep the maps' own exposure: only the input image goes through
 * the camera. global: the input has indirect light.
 *
 * With an environment (setting B) the input is the sum of both images; direct is what the rendering layer makes of
 * flash and coefficients, and indirect takes up what that lacks of the truth: bounces, and the environment's shadows.
 * The environment's highlights, as far as its coefficients know them (optics/ambient.h), are in the input alone, so
 * that they are not counted twice where the relighter samples a map. MERLIN_NO_MEMORY. */
status train_prepare(const train_view *v, bool global, const train_camera *lens, const train_lighting *lighting,
                     rng *noise);

/* What is left to do for the point setting behind train_photograph: the relit image, clipped direct light, binary
 * masks, maps in the network's ranges. */
void train_finish(const train_view *v, vec3 target);

/* A target light on the frontal hemisphere (Sang & Chandraker 2020). */
vec3 train_draw_light(rng *r);

/* How much an environment counts beside the flash: evenly in the logarithm, from hardly visible to as rendered. */
float train_draw_strength(rng *r);
/* The same for a target's environment, but a share of them has none: 0. */
float train_draw_target_strength(float dark_share, rng *r);

/* Adds what the maps' diffuse part reflects of an environment, times coverage, to image: size × size × 3. */
void train_add_environment(const train_view *maps, const float sh[9][3], float *image);

/* Direct light of the maps (albedo and roughness in [0, 1]) under a point light, clipped to [0, 1], zero outside the
 * mask: size × size × 3. */
void train_render(const train_view *maps, vec3 light, float *out);

#endif
