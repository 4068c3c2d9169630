/* SPDX-License-Identifier: MIT */
/* merlin/model: trained weights, opened for use.
 *
 *     merlin_model *model;
 *     if (merlin_model_open("merlin-any.safetensors", &model) ||
 *         merlin_model_add_flash(model, "merlin-point.safetensors"))
 *         fprintf(stderr, "%s\n", merlin_error());
 *     ...
 *     merlin_model_close(model); */
#ifndef MERLIN_MODEL_H
#define MERLIN_MODEL_H

#include <merlin/status.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct merlin_model merlin_model;

/* Opens a weights file, such as the shipped merlin-any, merlin-point and merlin-env. MERLIN_BAD_INPUT if it is not one.
 */
merlin_status merlin_model_open(const char *weights, merlin_model **out);
/* Adds to a model of any light another one that is more accurate for photographs lit by a flash alone. merlin_estimate
 * decides by the first one's estimate of the light; maps.model names the one it used. MERLIN_WRONG_USE if the first
 * assumes a flash, or has another already. The weights are read when a photograph first needs them. */
merlin_status merlin_model_add_flash(merlin_model *model, const char *weights);
/* Adds to a model of any light another one that sees several photographs of an object together, such as the shipped
 * merlin-several: it tells their lights, and the coarse part of shape and material. merlin_maps_from_capture uses it.
 * MERLIN_WRONG_USE if the first assumes a flash, or has another already, or if this one sees one photograph at a time.
 */
merlin_status merlin_model_add_several(merlin_model *model, const char *weights);
void merlin_model_close(merlin_model *model);
/* Returns the first weights' name, valid while the model is open; "" for NULL. merlin_relighting_model names those that
 * relight maps. */
const char *merlin_model_name(const merlin_model *model);

#ifdef __cplusplus
}
#endif

#endif
