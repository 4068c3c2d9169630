/* SPDX-License-Identifier: MIT */
/* The recursive network of photometric stereo under near lights, in the manner of Fast-NFPS (Lichy, Sengupta and
 * Jacobs, CVPR 2022): normals from pictures and known lights at a coarse scale, then better ones at each finer scale
 * from those before. Depth between the scales is integrated from the normals (stereo/integrate), so that each scale
 * learns by itself.
 *
 * A stage sees, for each picture, NFPS_PICTURE values of "picture" and NFPS_LIGHT of "light" (nfps/nfps_inputs.h) and,
 * for the object, "mask" 1, NFPS_MATTE of "matte" and, after the first scale, "normal" 3. Its output is "normal" 3,
 * unit, of the object. Normals and directions are turned so that (0, 0, 1) is toward the eye at every pixel, whatever
 * the lens. The first scale has weights of its own, all others share theirs. Sizes are multiples of 4.
 *
 * Smaller than published: 2×2 pixels are packed into channels and no kernel is larger than 3×3. Pictures are compared
 * by their maximum and their mean; and each pixel's values are also given relative to its own in all pictures, which
 * takes the albedo out (Chen et al., PS-FCN (Norm.), TPAMI 2020). Other than published: each pixel's own normal as a
 * matte surface (nfps/nfps_matte.h), and the pictures' features at half the size beside those at a quarter.
 *
 * Graphs of MODEL_TRAINING have the first scale's inputs at half of the size, "first_picture" and so on, besides the
 * others, and the inputs "first_normal_true", "first_loss_mask", "normal_true" and "loss_mask" with the losses
 * "first_normal" and "normal"; those of MODEL_WHOLE have both outputs, "first_normal" and "normal", and no losses. */
#ifndef MERLIN_MODEL_NFPS_H
#define MERLIN_MODEL_NFPS_H

#include "model/model_config.h"
#include "model/model_part.h"
#include "nn/nn.h"

enum { NFPS_PICTURE = 4, NFPS_LIGHT = 5, NFPS_MATTE = 5 };

/* Builds the network's part into g: MODEL_WHOLE, MODEL_TRAINING (of any losses), MODEL_FIRST or MODEL_REFINE;
 * MERLIN_WRONG_USE for those that only networks of one photograph have. */
status nfps_build(nn_graph *g, const model_config *config, model_part part);

#endif
