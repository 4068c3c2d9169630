/* SPDX-License-Identifier: MIT */
/* merlin: one photograph of an object, taken apart into its material and lit again from elsewhere.
 *
 *     merlin_image photo, alpha;
 *     merlin_model *model;
 *     merlin_maps maps;
 *     merlin_image relit;
 *     const float from_the_left[3] = {-0.8f, 0.3f, -0.5f};
 *
 *     if (merlin_image_read("cup.jpg", &photo, &alpha) || merlin_model_open("merlin-point.safetensors", &model) ||
 *         merlin_estimate(model, &photo, &alpha, NULL, &maps) ||
 *         merlin_relight(model, &maps, from_the_left, MERLIN_BY_BRDF, &relit) ||
 *         merlin_maps_write(model, &maps, NULL, "cup.merlin") || merlin_image_write("cup-from-left.png", &relit))
 *         fprintf(stderr, "%s\n", merlin_error());
 *
 * Each header is a subject; this one includes them all, and says what holds for all.
 *
 *     status.h       errors, progress, threads
 *     image.h        pixels
 *     pictures.h     sheets and animations
 *     camera.h       lenses
 *     warnings.h     what should be known of a result
 *     files.h        what was written or left aside
 *     weights.h      what is in a weights file
 *     model.h        weights to work with
 *     maps.h         what an object is made of
 *     estimate.h     from a photograph to maps
 *     lights.h       lamps, surroundings, found light
 *     relight.h      from maps to new light
 *     stereo.h       from pictures under many lights to a surface
 *     calibrate.h    where lights were
 *     mesh.h         maps and surfaces as triangles
 *     view.h         maps as a page
 *     export.h       maps for other programs
 *
 * Images are float, interleaved, rows from the top, on linear sRGB primaries. Space: the camera is at the origin and
 * looks along -z, x right, y up; the object stands near (0, 0, -1).
 *
 * Functions return MERLIN_OK (0) or what went wrong; merlin_error() then says it in words, per thread. What a function
 * fills in is yours to free; it is overwritten, not freed first, and after a failure it is empty. Pointers must not be
 * NULL unless a comment says so (MERLIN_WRONG_USE); what frees or closes takes NULL, and then does nothing. Nothing is
 * printed, nothing exits. There are no globals but how many threads work: a model may be used from several threads
 * (runs through one model take turns). Processes do not share it: where the parent has called the library, what fork
 * leaves in the child lacks the threads of OpenMP and would wait for them for ever, so let the child exec, or fork
 * before the first call. */
#ifndef MERLIN_MERLIN_H
#define MERLIN_MERLIN_H

#include <merlin/calibrate.h>
#include <merlin/camera.h>
#include <merlin/estimate.h>
#include <merlin/export.h>
#include <merlin/files.h>
#include <merlin/image.h>
#include <merlin/lights.h>
#include <merlin/maps.h>
#include <merlin/mesh.h>
#include <merlin/model.h>
#include <merlin/pictures.h>
#include <merlin/relight.h>
#include <merlin/status.h>
#include <merlin/stereo.h>
#include <merlin/view.h>
#include <merlin/warnings.h>
#include <merlin/weights.h>

#endif
