/* SPDX-License-Identifier: MIT */
/* Prepares a sample for one presentation to the network: masks, the photograph with a camera's faults, the target light
 * and its image. All random numbers depend on (seed, presentation) alone. */
#ifndef MERLIN_LAB_TRAIN_SAMPLES_PREPARE_H
#define MERLIN_LAB_TRAIN_SAMPLES_PREPARE_H

#include "base/rng.h"
#include "base/vec.h"
#include "lab/train/config/streams.h"
#include "lab/train/config/train_config.h"
#include "lab/train/samples/dataset.h"
#include "lab/train/samples/train_camera.h"

/* The light of a presentation, apart from the flash. */
typedef struct train_lighting {
    vec3 target; /* position of the target's point light */
    /* for views with environments only: */
    float strength;        /* factor of the photograph's environment */
    float target_sh[9][3]; /* environment of the target */
} train_lighting;

/* Converts an unpacked sample (dataset.h) to the network's inputs and targets: binary masks (mask: more than half
 * covered, with errors of the outline; loss_mask: wholly covered and inside the mask), image encoded for the network,
 * direct clipped as by the rendering layer, reconstruction = clipped direct + indirect, relit = the BRDF under light,
 * maps in the network's ranges. The targets have the maps' own exposure: only the input image goes through the camera.
 * global: the input has indirect light.
 *
 * With an environment (setting B) the input is the sum of both images; direct is what the rendering layer makes of
 * flash and coefficients, and indirect the remainder of the truth: bounces, and the environment's shadows. The
 * environment's highlights, as far as its coefficients describe them (optics/ambient.h), are in the input only, so that
 * they are not counted twice when relighting samples a map. MERLIN_NO_MEMORY. */
status train_prepare(const train_view *v, bool global, const train_camera *lens, const train_lighting *lighting,
                     rng *noise);

/* Completes the point setting after train_photograph: the relit image, clipped direct light, binary masks, maps in the
 * network's ranges. */
void train_finish(const train_view *v, vec3 target);

/* Returns a random target light on the frontal hemisphere (Sang & Chandraker 2020). */
vec3 train_draw_light(rng *r);

/* Returns the strength of a photograph's environment: log-uniform, from hardly visible to as rendered. */
float train_draw_strength(rng *r);
/* Returns the strength of a target's environment: the same, but 0 for a share of them. */
float train_draw_target_strength(float dark_share, rng *r);

/* Adds what the maps' diffuse part reflects of an environment, times coverage, to image: size × size × 3. */
void train_add_environment(const train_view *maps, const float sh[9][3], float *image);

/* Computes direct light of the maps (albedo and roughness in [0, 1]) under a point light, clipped to [0, 1], zero
 * outside the mask: size × size × 3. */
void train_render(const train_view *maps, vec3 light, float *out);

#endif
