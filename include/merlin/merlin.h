/* SPDX-License-Identifier: MIT */
/* merlin: from one photograph of an object to its material, and to the object in other light.
 *
 *     merlin_image photo, alpha;
 *     merlin_model *model;
 *     merlin_maps maps;
 *     merlin_image relit;
 *     const float from_the_left[3] = {-0.8f, 0.3f, -0.5f};
 *     if (merlin_image_read("cup.jpg", &photo, &alpha) || merlin_model_open("merlin-point.safetensors", &model) ||
 *         merlin_estimate(model, &photo, &alpha, NULL, &maps) ||
 *         merlin_relight(model, &maps, from_the_left, MERLIN_BY_BRDF, &relit) ||
 *         merlin_maps_write(model, &maps, NULL, "cup.merlin") || merlin_image_write("cup-from-left.png", &relit))
 *         fprintf(stderr, "%s\n", merlin_error());
 *
 * Each header has one subject; this one includes them all, and states what applies to all.
 *
 *     status.h       errors, progress, threads
 *     image.h        pixels
 *     pictures.h     sheets and animations
 *     photos.h       the photographs of a folder, and their masks
 *     frames.h       frames of a video or of numbered pictures
 *     camera.h       lenses
 *     warnings.h     what one should know about a result
 *     files.h        files that were written or skipped
 *     weights.h      the content of a weights file
 *     model.h        weights, opened for use
 *     maps.h         material and shape of an object
 *     estimate.h     from a photograph to maps
 *     sequences.h    maps of a video's frames that do not flicker
 *     lights.h       lamps, environments, estimated light
 *     relight.h      from maps to new light
 *     stereo.h       from pictures under many lights to a surface
 *     calibrate.h    directions of lights
 *     surface.h      files and maps of a surface; one from a photograph
 *     mesh.h         maps and surfaces as triangles
 *     view.h         maps as a page
 *     export.h       maps for other programs
 *     rti.h          pictures under many lights, to be relit in a browser
 *
 * Images are float, interleaved, rows from the top, on linear sRGB primaries. Space: the camera is at the origin and
 * looks along -z, x right, y up; the object is near (0, 0, -1).
 *
 * Functions return MERLIN_OK (0) or an error code; merlin_error() then returns a message, per thread, in words for a
 * person. The caller frees what a function fills in; it is overwritten, not freed first, and empty after a failure.
 * Pointers must not be NULL unless a comment says so (MERLIN_WRONG_USE); functions that free or close accept NULL, and
 * then do nothing.
 *
 * The library does not print or exit. Its only global state is the number of threads: a model may be used from several
 * threads (its runs are made one at a time). Processes cannot share it: if the parent has called the library, a forked
 * child lacks the threads of OpenMP and would wait for them forever: let it exec, or fork before the first call. */
#ifndef MERLIN_MERLIN_H
#define MERLIN_MERLIN_H

#include <merlin/calibrate.h>
#include <merlin/camera.h>
#include <merlin/estimate.h>
#include <merlin/export.h>
#include <merlin/files.h>
#include <merlin/frames.h>
#include <merlin/image.h>
#include <merlin/lights.h>
#include <merlin/maps.h>
#include <merlin/mesh.h>
#include <merlin/model.h>
#include <merlin/photos.h>
#include <merlin/pictures.h>
#include <merlin/relight.h>
#include <merlin/rti.h>
#include <merlin/sequences.h>
#include <merlin/status.h>
#include <merlin/stereo.h>
#include <merlin/surface.h>
#include <merlin/view.h>
#include <merlin/warnings.h>
#include <merlin/weights.h>

#endif
