/* SPDX-License-Identifier: MIT */
/* The two trivial answers that a model must beat: the data set's mean maps, and maps inflated from the mask.
 *
 *     eval_means means;
 *     status s = eval_means_of_folder("train", 0, false, NULL, &means);
 *     if (s == OK) s = eval_means_write(&means, "means.exr");
 *     ...
 *     surface guess;
 *     s = eval_inflate(&photo, &mask, &means, &guess);
 */
#ifndef MERLIN_LAB_EVAL_SAMPLES_TRIVIAL_H
#define MERLIN_LAB_EVAL_SAMPLES_TRIVIAL_H

#include <stdbool.h>
#include <stddef.h>

#include "lab/eval/samples/photograph.h"

/* Per pixel the mean over those samples whose mask holds the pixel (normals renormalized); where none does, the mean
 * over all. */
typedef struct eval_means {
    surface maps;           /* without a mask */
    float roughness, depth; /* over all pixels of all masks */
    float sh[9][3];         /* of the environments; 0 where the samples have none */
    size_t samples;
} eval_means;

/* Over the first limit samples of a folder made by `merlin-lab render` (0: all); they must share one size. stopped (may
 * be NULL) is polled between samples. */
status eval_means_of_folder(const char *folder, size_t limit, bool quiet, int (*stopped)(void), eval_means *out);
void eval_means_free(eval_means *means);
/* Means as an EXR file with a sample's channel names and ranges. */
status eval_means_write(const eval_means *means, const char *path);
/* Resized to width × height. */
status eval_means_read(const char *path, int width, int height, eval_means *out);

/* Maps from one flash photograph, whose exposure is known, without learning anything: normals and relief by pst_inflate
 * (stereo/uncalibrated/inflate.h), depth with the data's mean, albedo as if every surface faced the flash and were
 * diffuse (I π d² / Φ, clipped), the data's mean roughness. mask: 0 or 1. */
status eval_inflate(const eval_photo *photo, const img *mask, const eval_means *means, surface *out);

#endif
