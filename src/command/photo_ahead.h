/* SPDX-License-Identifier: MIT */
/* A photograph read, and its object found, by a thread of its own while something else is done
 * (docs/notes/estimate_time.md).
 *
 *     photo_ahead first;
 *     photo_begin(&first, &job);
 *     ... open the model ...
 *     status s = photo_finish(&first, &taken);
 */
#ifndef MERLIN_COMMAND_PHOTO_AHEAD_H
#define MERLIN_COMMAND_PHOTO_AHEAD_H

#include <pthread.h>
#include <stdbool.h>

#include "command/photos.h"
#include "merlin/estimate.h"

/* A photograph in memory, its object, and what is known of how it was taken. */
typedef struct photo_taken {
    merlin_image photo;
    merlin_object object;
    merlin_shot shot;
    double read_seconds;
} photo_taken;
void photo_taken_free(photo_taken *taken);

typedef struct photo_ahead {
    const photo_job *job; /* borrowed */
    bool running;
    pthread_t thread;
    photo_taken taken;
    status result;
    char message[1024]; /* words are kept per thread, and this one goes away */
} photo_ahead;

/* Every begin needs its finish. */
void photo_begin(photo_ahead *ahead, const photo_job *job);
/* Waits. It is the caller's then, empty after a failure. */
status photo_finish(photo_ahead *ahead, photo_taken *out);

/* The same without a thread. */
status photo_take(const photo_job *job, photo_taken *out);

/* Estimates it by these params, but for their hint and shot; it is empty then. */
status photo_estimate(merlin_model *model, photo_taken *taken, const merlin_params *params, merlin_maps *maps);

/* Does all of it; mask (its own then, or found) and params (the usual ones then) may be NULL. The message names the
 * photograph. */
status photo_maps(merlin_model *model, const char *photo, const char *mask, const merlin_params *params,
                  merlin_maps *maps);

#endif
