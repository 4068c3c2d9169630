/* SPDX-License-Identifier: MIT */
/* merlin/model: trained weights, opened to work with.
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

/* Reads a weights file, such as the shipped merlin-any, merlin-point and merlin-env. MERLIN_BAD_INPUT for what is none.
 */
merlin_status merlin_model_open(const char *weights, merlin_model **out);
/* Gives a model of any light another for photographs that are lit by a flash alone, which knows that light better:
 * merlin_estimate asks the first what it sees, and maps.model says which one the maps are by. MERLIN_WRONG_USE if the
 * first knows one light alone, or has such another. The weights are read when a photograph first asks for them. */
merlin_status merlin_model_add_flash(merlin_model *model, const char *weights);
void merlin_model_close(merlin_model *model);
/* Returns the first weights' name, as long as the model is open; "" for NULL. */
const char *merlin_model_name(const merlin_model *model);

#ifdef __cplusplus
}
#endif

#endif
