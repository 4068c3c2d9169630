/* SPDX-License-Identifier: MIT */
/* merlin/estimate: one photograph of an object, taken apart into maps of its material and shape.
 *
 *     merlin_image photo, alpha;
 *     merlin_maps maps;
 *     if (merlin_image_read("cup.jpg", &photo, &alpha) || merlin_estimate(model, &photo, &alpha, NULL, &maps))
 *         fprintf(stderr, "%s\n", merlin_error());
 *
 * The photograph is best taken with the camera's flash: most models were trained on objects lit by a light beside the
 * lens. */
#ifndef MERLIN_ESTIMATE_H
#define MERLIN_ESTIMATE_H

#include <merlin/maps.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Facts of how a photograph was taken, as far as they are known. */
typedef enum merlin_flash { MERLIN_FLASH_UNKNOWN, MERLIN_FLASH_NONE, MERLIN_FLASH_FIRED } merlin_flash;

typedef struct merlin_shot {
    merlin_flash flash;
    float focal_35mm; /* the focal length in mm whose picture on 36 x 24 mm has as wide a diagonal; 0: unknown */
    int reduced;      /* so many of the file's pixels a side became one, as merlin_image_read has it: 0 or 1 for most */
    int frames;       /* of an animation, whose first alone is read: 0 or 1 for most */
} merlin_shot;

/* Reads them from the EXIF of a JPEG, PNG, WebP, HEIC, TIFF or raw picture, and the file's head; unknown without. */
merlin_status merlin_shot_read(const char *path, merlin_shot *out);

/* Help for the search for the object, where there is no mask: coordinates in whole pixels of the photograph, from its
 * upper left corner. */
enum { MERLIN_MOST_POINTS = 16 };
typedef struct merlin_hint {
    int point_count;
    struct {
        int x, y;
    } point[MERLIN_MOST_POINTS]; /* pixels of the object */
    struct {
        int x, y, width, height;
    } box; /* holds all of the object, the tighter the better; width 0: none */
} merlin_hint;

/* Bounds of params.size, a multiple of the last. */
enum { MERLIN_LEAST_SIZE = 64, MERLIN_LARGEST_SIZE = 512, MERLIN_SIZE_STEP = 32 };

typedef struct merlin_params {
    int size;  /* side of the square the network sees: a multiple of 32, from 64 to 512. It was trained at 256; of
                * more it takes fine normals alone, if the photograph shows the object so large */
    int views; /* in how many of the square's eight orientations the network sees it; the mean is taken */
    int auto_exposure; /* 1: bring a photograph that is too dark or too bright, up to a million times (floats may be in
                        * any unit), to the brightness of the training data */
    float exposure;    /* EV on top if auto_exposure is 0, within 20 */
    int (*stop)(void); /* asked between stages; returning nonzero ends the work with MERLIN_STOPPED; may be NULL */
    merlin_progress progress; /* told of "estimating" and "refining"; may be NULL */
    void *progress_context;
    merlin_shot shot; /* of the photograph: its lens, and doubts in its maps */
    int flash;        /* 1: its light was a flash at the lens and nothing else, which models of any light are told */
    float fov;        /* degrees that the photograph is wide, from 1 to 150; 0: by shot, if that knows the lens */
    merlin_hint hint; /* where the object is, if it is searched for; MERLIN_WRONG_USE with a mask */
    int last; /* 1: no photograph follows: the model lets go of what it would keep for the next one, as early as it can.
               * It writes these maps and relights them as well as ever */
} merlin_params;

merlin_params merlin_params_default(void); /* 512, 4 views, automatic, never stopped */

/* Makes maps of a photograph. photo: 3 channels, at least 16 pixels a side and at most 64 million pixels. mask: 1
 * channel of the same size, coverage in [0, 1]: what is covered by half or more is the object; NULL or without data:
 * the object is searched for. params NULL: the defaults. */
merlin_status merlin_estimate(merlin_model *model, const merlin_image *photo, const merlin_image *mask,
                              const merlin_params *params, merlin_maps *maps);

/* ---- the same in two steps ---- */

/* Which part of a photograph is the object: to be shown to a person, who may know better, or to be found while the
 * model is still opened by another thread. */
typedef struct merlin_object {
    merlin_image mask; /* 1, coverage in [0, 1], of the photograph's size */
    merlin_mask_source source;
    float confidence; /* 1 for a given mask; how likely a found one is right, in [0, 1] */
    double seconds;   /* that it took */
} merlin_object;

/* Finds it. photo, mask and hint: as of merlin_estimate; mask and hint may be NULL. */
merlin_status merlin_object_find(const merlin_image *photo, const merlin_image *mask, const merlin_hint *hint,
                                 merlin_object *out);
void merlin_object_free(merlin_object *object);
/* As merlin_estimate, but for params.hint. Photograph and object are taken over, and are empty when it returns,
 * whatever it returns: a large photograph is freed before its maps need the memory. */
merlin_status merlin_estimate_object(merlin_model *model, merlin_image *photo, merlin_object *object,
                                     const merlin_params *params, merlin_maps *maps);
/* Does now what the first photograph by these params would begin with, which takes some tenths of a second: while that
 * is read, and its object found, by another thread. */
merlin_status merlin_model_prepare(merlin_model *model, const merlin_params *params);

#ifdef __cplusplus
}
#endif

#endif
