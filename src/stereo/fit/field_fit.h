/* SPDX-License-Identifier: MIT */
/* The robust fit of pixel_fit.h or lobe_fit.h for many pixels: gathers each pixel's values from the pictures, and its
 * lights if they are near.
 *
 *     pst_field f = {.problem = p, .pixel = p->pixel, .count = p->pixel_count, .b = normals};
 *     double cost;
 *     status s = pst_field_fit(&f, &cost);
 */
#ifndef MERLIN_STEREO_FIT_FIELD_FIT_H
#define MERLIN_STEREO_FIT_FIELD_FIT_H

#include "stereo/fit/fall_off.h"
#include "stereo/fit/field.h"
#include "stereo/integrate/stereo_surface.h"

/* Fits all pixels. cost: sum of their robust losses, in their order whatever the number of threads. */
status pst_field_fit(const pst_field *f, double *cost);

/* Does the same, starting from the field's shading. */
status pst_field_refine(const pst_field *f, double *cost);

/* Continues with pst_lobe_search where the shading costs more than the limit. */
status pst_field_search(const pst_field *f, float limit);

/* Fits the second lobe, too, near the shading, and keeps it where it costs far less. */
status pst_field_try_second(const pst_field *f);

/* Sums the prediction errors of pst_lobe_predict; the field's shading is neither read nor written. */
status pst_field_predict(const pst_field *f, double *cost);

/* Fits again from the four neighbours' results where they differ, and keeps what costs less; at most this many times
 * over all pixels. */
status pst_field_spread(const pst_field *f, int sweeps);

/* Fits single pixels and speckles, where a wrong surface costs less than the right one, again from their neighbours if
 * most of these contradict them. Differing from all of them costs as much as pixels of this field cost on average; this
 * many times over all pixels. */
status pst_field_replace_outliers(const pst_field *f, int sweeps);

/* Sets the shading to these normals (3 channels, of the pictures' size), with the albedo of a surface without gloss. */
status pst_field_given(const pst_field *f, const img *normal);

/* Computes each observation's weight in the fit, and its value by the fit (both count × pst_padded(pictures)). */
status pst_field_model(const pst_field *f, float *weight, float *model);

/* Estimates each pixel's depth from its shading (count); only with near lights. */
status pst_field_fall_off(const pst_field *f, pst_fall_off *out);

/* Writes normal, albedo, residual and spread into the surface's pictures. The field's shading becomes zeros, whose
 * memory goes back to the system, as these pictures take as much. */
status pst_field_store(const pst_field *f, merlin_surface *out);

/* Returns the index in the field by position in the picture, -1 outside; malloc'ed, NULL if there is no memory. */
int32_t *pst_field_slots(const pst_field *f);

/* Gathers grey values (the mean of the channels, each under unit intensity) of count pixels, and whether they are
 * usable (1, 0): all pictures of one pixel together, pst_padded(pictures) per pixel, pixels `stride` apart. */
void pst_gather(const pst_problem *p, const uint32_t *pixel, size_t count, float *value, float *usable, size_t stride);

/* Selects count of the problem's pixels, evenly spread (fewer if there are fewer); malloc'ed. */
status pst_field_sample(const pst_problem *p, size_t count, uint32_t **pixel, size_t *found);

/* Returns the ray through the centre of a pixel, with z = -1. */
static inline vec3 pst_ray(const pinhole *camera, int x, int y)
{
    return vec3_make(((float)x + 0.5f - camera->x) / camera->focal, (camera->y - (float)y - 0.5f) / camera->focal, -1);
}

#endif
