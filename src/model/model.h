/* SPDX-License-Identifier: MIT */
/* MERLiN and its ablations as graphs.
 *
 * A model is its configuration (JSON: configs/models/NAME.json, and inside every weights file) plus parameters. The
 * graph's inputs and outputs have fixed names, so that training, evaluation and inference treat every variant alike:
 *
 *  inputs   "image"  3, model_encode_image of the linear image, multiplied by the mask
 *           "mask"   1
 *           "light"  vector 3 or 30: the target's lighting code: a position, and with "lighting": "both" an
 *                    environment's model_encode_sh
 *           "light_position" vector 3: the target light's position
 *  outputs  "albedo" 3 in [-1, 1]   "normal" 3 unit   "roughness" 1 in [-1, 1]   "depth" 1, scene units
 *           "direct" 3: rendering layer under the flash    "indirect" 3: global-illumination residual for "direct"
 *           "relit_direct" 3: by the relighting decoder    "relit_brdf" 3: by the rendering layer
 *
 * Maps are undefined outside the mask; images are zero there. A variant without global illumination has no "indirect",
 * one that relights by BRDF no "light" and no "relit_direct" (nn_output_data: NULL). "indirect" may be slightly
 * negative.
 *
 * With "lighting": "both" the photograph shows the object under its flash and an environment at once:
 * "environment_code" (vector 27) is the predicted environment, "environment" (3) what the rendering layer makes of it,
 * "direct" includes it, and both relit images are under point light and environment.
 *
 * Training adds inputs "loss_mask" 1, "albedo_true" 3 and "roughness_true" 1 in [-1, 1], "normal_true" 3, "depth_true"
 * 1, "direct_true" 3, "indirect_true" 3, "reconstruction_true" 3 and "relit_true" 3, and the losses "albedo", "normal",
 * "depth", "roughness", "roughness_gradient", "direct", "indirect", "reconstruction", "relight"; for both lights also
 * "environment_true" (vector 27) and the loss "environment".
 *
 * With "lighting": "any" the photograph shows the object under any light through any lens. Additional inputs are
 * "sight" 4, what is known of the lens (model_sight), and "lens" (vector 3, nn_render_inputs), the lens through which
 * the maps are rendered. "depth" is then relief in widths of the frame, as for nn_render; "direct", "indirect" and
 * "relit_brdf" are under a flash or the target light, whatever lit the photograph. The photograph's light is "lights"
 * (vector MODEL_LIGHTS), and "visibility" 1 in [0, 1], the share of the strongest lamp's light that is not blocked by
 * the object itself. Training adds inputs "lights_true", "lamp_weight" and "rest_weight" (vectors of 1),
 * "visibility_true" 1 and "visibility_weight" 1, and the losses "flash", "lamp", "lamp_distance", "lamp_light",
 * "environment" and "visibility".
 *
 * With "several" the batch consists of objects with several such photographs each (nn.h, "several pictures of an
 * object"), taken from one place. Additional is the input "share" 1 (model_encode_shares). Inputs and outputs that
 * belong to a photograph are "image", "sight", "share", "lights",
 * "visibility", and the truth and weights of the latter two; all others are one for each object. With one photograph
 * the network is that of "lighting": "any" until it is trained.
 *
 * With "nfps_width" it is another network altogether, which makes normals of pictures under known lights
 * (model/nfps.h).
 *
 * With "only_lights" there is no output but "lights", and there are no losses but those of it. */
#ifndef MERLIN_MODEL_MODEL_H
#define MERLIN_MODEL_MODEL_H

#include "model/model_codes.h"
#include "model/model_config.h"
#include "model/model_part.h"
#include "nn/nn.h"

enum { MODEL_SIZE_MULTIPLE = 32, MODEL_LOSSES = 19 };

/* Names of the losses; a variant may lack some (nn_loss: NAN). New ones are appended, so that columns of older curves
 * keep their meaning. */
extern const char *const model_losses[MODEL_LOSSES];

/* Names of the relighting decoder's inputs that do not depend on the light, ended by NULL: the encoder's features at
 * levels 0 to 4 and the material decoder's at 0 to 3, level i of widths[i] channels at 1/2^(i+1) of the size. A variant
 * without feature sharing does not use the latter (nn_input_data: NULL), one that relights by BRDF none. */
enum { MODEL_FEATURES = 2 * MODEL_LEVELS - 1 };
extern const char *const model_features[MODEL_FEATURES + 1];
/* Returns the number of values of one of them, for a picture of size × size. */
size_t model_feature_values(const model_config *config, int feature, int size);

status model_build(const model_config *config, model_part part, nn_graph **out);

/* Reads a weights file: configuration and parameters. *params fits MODEL_WHOLE's graph and is for inference only
 * (nn_params_open). */
status model_load(const char *weights, model_config *config, nn_params **params);
/* Reads the configuration alone. */
status model_load_config(const char *weights, model_config *config);

#endif
