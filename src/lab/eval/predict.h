/* SPDX-License-Identifier: MIT */
/* A model as the evaluation runs it: a picture's maps once, then relit under four lights at a time, as often as wanted.
 *
 *     eval_model *m;
 *     status s = eval_model_open("weights.safetensors", 256, NN_FLOAT32, 1, &m);
 *     eval_prediction p;
 *     if (s == OK) s = eval_prediction_new(m, &p);
 *     if (s == OK) s = eval_estimate(m, &image, &mask, &p);
 *     if (s == OK) s = eval_relight(m, &mask, lights, &p);
 *     ...
 *     eval_prediction_free(&p);
 *     eval_model_close(m);
 */
#ifndef MERLIN_LAB_EVAL_PREDICT_H
#define MERLIN_LAB_EVAL_PREDICT_H

#include "estimate/photo/view.h"
#include "lab/eval/maps.h"
#include "model/model.h"
#include "optics/orientation.h"

enum { EVAL_LIGHTS = 4 };

typedef struct eval_model eval_model;

/* size: side of the square pictures, a multiple of MODEL_SIZE_MULTIPLE. Maps are the mean over `views` orientations of
 * the picture, 1 to 8 (estimate/photo/view.h), and so is what the relighting decoder gives. */
status eval_model_open(const char *weights, int size, nn_type type, int views, eval_model **out);
void eval_model_close(eval_model *m);
const model_config *eval_model_config(const eval_model *m);

/* Pictures are clipped to [0, 1] and zero outside the mask; those that the model's variant lacks stay black. */
typedef struct eval_prediction {
    eval_maps maps;
    img flash;                        /* bounce 1 of the flash alone */
    img indirect;                     /* what the network adds to the flash and the surroundings */
    img reconstruction;               /* direct + indirect light, of the surroundings too */
    float sh[9][3];                   /* the surroundings as estimated, by models of setting B; else 0 */
    view_features seen[ORIENTATIONS]; /* by the model's views, for the relighting decoder */
    img by_network[EVAL_LIGHTS];      /* the relighting decoder */
    img by_brdf[EVAL_LIGHTS];         /* the rendering layer */
    img full_by_network[EVAL_LIGHTS]; /* the same, with the light that the global-illumination network adds */
    img full_by_brdf[EVAL_LIGHTS];
    img shadowed[EVAL_LIGHTS]; /* full_by_brdf with cast shadows, by eval_relight_shadows */
} eval_prediction;

status eval_prediction_new(const eval_model *m, eval_prediction *out);
void eval_prediction_free(eval_prediction *p);

/* Maps, flash, indirect, reconstruction, sh. image: linear, lit by the flash (setting B: in surroundings), zero outside
 * the mask. */
status eval_estimate(eval_model *m, const img *image, const img *mask, eval_prediction *out);

/* After eval_estimate of the same picture: by_network, by_brdf, both in full. Only models of setting B relight under
 * surroundings. */
status eval_relight(eval_model *m, const img *mask, const illumination lights[EVAL_LIGHTS], eval_prediction *out);

/* After eval_relight with the same lights: the cast shadows that merlin relight makes of such maps. fov in degrees. */
status eval_relight_shadows(eval_model *m, const img *mask, float fov, const illumination lights[EVAL_LIGHTS],
                            eval_prediction *p);

/* Whether the variant has a relighting decoder. */
bool eval_model_relights(const eval_model *m);

#endif
