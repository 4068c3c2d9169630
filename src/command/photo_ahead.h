/* SPDX-License-Identifier: MIT */
/* A photograph read, and its object found, by a thread of its own while something else is done
 * (docs/notes/estimate_time.md).
 *
 *     photo_ahead first;
 *     photo_begin(&first, &job);
 *     ... open the model ...
 *     status s = photo_finish(&first, &photo, &object);
 */
#ifndef MERLIN_COMMAND_PHOTO_AHEAD_H
#define MERLIN_COMMAND_PHOTO_AHEAD_H

#include <pthread.h>
#include <stdbool.h>

#include "command/photos.h"
#include "estimate/photo/photo_object.h"

typedef struct photo_ahead {
    const photo_job *job; /* borrowed */
    bool running;
    pthread_t thread;
    merlin_image photo;
    photo_object object;
    status result;
    char message[1024]; /* words are kept per thread, and this one goes away */
} photo_ahead;

/* Every begin needs its finish. */
void photo_begin(photo_ahead *ahead, const photo_job *job);
/* Waits. Both are the caller's then, empty after a failure. */
status photo_finish(photo_ahead *ahead, merlin_image *photo, photo_object *object);

/* The same without a thread. */
status photo_read_object(const photo_job *job, merlin_image *photo, photo_object *object, double *read_seconds);

/* All of it, and estimated; mask (its own then, or found), params (the usual ones then) and shown may be NULL. The
 * message names the photograph. */
status photo_maps(merlin_model *model, const char *photo, const char *mask, const merlin_params *params,
                  const watch *shown, merlin_maps *maps);

#endif
