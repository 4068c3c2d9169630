/* SPDX-License-Identifier: MIT */
/* The robust fit of pixel_fit.h over many pixels: gathers each pixel's values from the pictures, and its lights where
 * they are near.
 *
 *     pst_field f = {.problem = p, .pixel = p->pixel, .count = p->pixel_count, .b = normals};
 *     double cost;
 *     status s = pst_field_fit(&f, &cost); */
#ifndef MERLIN_STEREO_FIT_FIELD_FIT_H
#define MERLIN_STEREO_FIT_FIELD_FIT_H

#include "stereo/fit/fall_off.h"
#include "stereo/fit/field.h"
#include "stereo/integrate/stereo_surface.h"

/* cost: the pixels' robust losses, summed in their order whatever the number of threads. */
status pst_field_fit(const pst_field *f, double *cost);

/* The same, started from the field's shading. */
status pst_field_refine(const pst_field *f, double *cost);

/* Searches on (pst_lobe_search) where the shading costs more than the limit. */
status pst_field_search(const pst_field *f, float limit);

/* Fits the second lobe, too, near the shading, and keeps what costs less by far. */
status pst_field_try_second(const pst_field *f);

/* cost: what pst_lobe_foretell says, summed; the field's shading is neither read nor written. */
status pst_field_foretell(const pst_field *f, double *cost);

/* Fits again from the four neighbours' results where they differ, and keeps what costs less; at most so many times over
 * all pixels. */
status pst_field_spread(const pst_field *f, int sweeps);

/* Lone pixels and speckles, where a wrong surface costs less than the right one: fits those that most neighbours
 * contradict again from these. To differ from all of them costs as much as pixels of this field cost on average; so
 * many times over all pixels. */
status pst_field_mend(const pst_field *f, int sweeps);

/* Each observation's share in the fit and what the fit makes of it (both count × pst_padded(pictures)). */
status pst_field_model(const pst_field *f, float *weight, float *model);

/* What each pixel's shading says of its depth (count); near lights only. */
status pst_field_fall_off(const pst_field *f, pst_fall_off *out);

/* Normal, albedo and residual into the surface's pictures. */
status pst_field_store(const pst_field *f, merlin_surface *out);

/* By place in the picture: where in the field, -1 outside; malloc'ed, NULL if there is no memory. */
int32_t *pst_field_slots(const pst_field *f);

/* Grey values (the mean of the channels, each under unit intensity) of count pixels and whether they are usable (1, 0):
 * one pixel's all pictures together, pst_padded(pictures) a pixel, the next pixel's stride behind. */
void pst_gather(const pst_problem *p, const uint32_t *pixel, size_t count, float *value, float *usable, size_t stride);

/* count of the problem's pixels, evenly spread (fewer where there are fewer); malloc'ed. */
status pst_field_sample(const pst_problem *p, size_t count, uint32_t **pixel, size_t *found);

/* The ray through the middle of a pixel, z = -1. */
static inline vec3 pst_ray(const pinhole *camera, int x, int y)
{
    return vec3_make(((float)x + 0.5f - camera->x) / camera->focal, (camera->y - (float)y - 0.5f) / camera->focal, -1);
}

#endif
