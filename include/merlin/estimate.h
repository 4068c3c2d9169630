/* SPDX-License-Identifier: MIT */
/* merlin/estimate: from one photograph of an object to maps of its material and shape.
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

/* Facts about how a photograph was taken, as far as they are known. */
typedef enum merlin_flash { MERLIN_FLASH_UNKNOWN, MERLIN_FLASH_NONE, MERLIN_FLASH_FIRED } merlin_flash;

typedef struct merlin_shot {
    merlin_flash flash;
    float focal_35mm; /* focal length in mm that gives the same diagonal angle of view on 36 x 24 mm; 0: unknown */
    int reduced;      /* number of the file's pixels a side that became one, as by merlin_image_read: 0 or 1 for most */
    int frames;       /* number of pictures of an animation, of which only the first is read: 0 or 1 for most */
} merlin_shot;

/* Reads them from the EXIF of a JPEG, PNG, WebP, HEIC, TIFF or raw picture, and the file's header. */
merlin_status merlin_shot_read(const char *path, merlin_shot *out);

/* A hint for the search for the object if there is no mask: coordinates in whole pixels of the photograph, from its
 * upper left corner. */
enum { MERLIN_MOST_POINTS = 16 };
typedef struct merlin_hint {
    int point_count;
    struct {
        int x, y;
    } point[MERLIN_MOST_POINTS]; /* pixels of the object */
    struct {
        int x, y, width, height;
    } box;       /* contains all of the object, as closely as possible; width 0: none */
    int reduced; /* points and box count a file's pixels, of which so many a side became one of the photograph, as
                  * merlin_shot's reduced says: 0 or 1 for most */
} merlin_hint;

/* Bounds of params.size, which is a multiple of the last. */
enum { MERLIN_LEAST_SIZE = 64, MERLIN_LARGEST_SIZE = 512, MERLIN_SIZE_STEP = 32 };

typedef struct merlin_params {
    int size; /* side of the square that the network sees: a multiple of 32, from 64 to 512. It was trained at 256; from
               * more it takes only fine normals, if the object has that many pixels in the photograph */
    int views; /* number of the square's eight orientations in which the network sees it; the estimates are averaged */
    int auto_exposure; /* 1: scale a photograph that is too dark or too bright, up to a million times (floats may be in
                        * any unit), to the brightness of the training data */
    float exposure;    /* additional EV if auto_exposure is 0, from -20 to 20 */
    int (*stop)(void); /* called between stages; a nonzero result ends the work with MERLIN_STOPPED; may be NULL */
    merlin_progress progress; /* called with "estimating" and "refining"; may be NULL */
    void *progress_context;
    merlin_shot shot; /* facts about the photograph: they give its lens, and warnings about its maps */
    int flash;        /* 1: its only light was a flash at the lens, which models of any light use */
    float fov;        /* horizontal field of view in degrees, from 1 to 150; 0: by shot, if that has the lens */
    merlin_hint hint; /* where the object is, for the search; MERLIN_WRONG_USE with a mask */
    const struct merlin_near_network *near_network; /* merlin_maps_from_capture: of near lights (merlin/stereo.h), for
                                                     * 3 pictures and more whose lens is known; NULL: without */
    int last; /* 1: no photograph follows: the model frees early what it would keep for the next one. It can still write
               * and relight these maps */
} merlin_params;

merlin_params merlin_params_default(void); /* Returns the defaults: 512, 4 views, automatic exposure, never stopped. */

/* Makes maps of a photograph. photo: 3 channels, at least 16 pixels a side and at most 64 million pixels. mask: 1
 * channel of the same size, coverage in [0, 1], with the object where it is half or more; NULL or without data: the
 * object is searched for. params NULL: the defaults. */
merlin_status merlin_estimate(merlin_model *model, const merlin_image *photo, const merlin_image *mask,
                              const merlin_params *params, merlin_maps *maps);

/* ---- the same in two steps ---- */

/* The part of a photograph that is the object, found separately to show it to a person who can correct it, or while
 * another thread opens the model. */
typedef struct merlin_object {
    merlin_image mask; /* coverage in [0, 1], 1 channel of the photograph's size */
    merlin_mask_source source;
    float confidence; /* 1 for a given mask; for a found one the probability that it is correct, in [0, 1] */
    double seconds;   /* time of the search in seconds */
} merlin_object;

/* Finds the object. photo, mask and hint: as for merlin_estimate; mask and hint may be NULL. */
merlin_status merlin_object_find(const merlin_image *photo, const merlin_image *mask, const merlin_hint *hint,
                                 merlin_object *out);
void merlin_object_free(merlin_object *object);
/* Makes maps as merlin_estimate does, except for params.hint. It takes over photograph and object, which are empty when
 * it returns, whatever it returns, so that a large photograph is freed before its maps need the memory. */
merlin_status merlin_estimate_object(merlin_model *model, merlin_image *photo, merlin_object *object,
                                     const merlin_params *params, merlin_maps *maps);
/* Prepares the model for the first photograph with these params, which takes some tenths of a second, for instance
 * while another thread reads the photograph and finds its object. */
merlin_status merlin_model_prepare(merlin_model *model, const merlin_params *params);

#ifdef __cplusplus
}
#endif

#endif
