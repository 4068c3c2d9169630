/* SPDX-License-Identifier: MIT */
/* Reads a photograph, and finds its object, in a separate thread while other work is done
 * (docs/notes/estimate_time.md).
 *
 *     photo_ahead first;
 *     photo_begin(&first, &job);
 *     ... open the model ...
 *     status s = photo_finish(&first, &taken); */
#ifndef MERLIN_COMMAND_PHOTO_AHEAD_H
#define MERLIN_COMMAND_PHOTO_AHEAD_H

#include <pthread.h>
#include <stdbool.h>

#include "command/photos.h"
#include "merlin/estimate.h"

/* A photograph in memory, its object, and facts about how it was taken. */
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
    char message[1024]; /* copied, as messages are kept per thread, and this thread ends */
} photo_ahead;

/* Starts the thread; each begin needs a finish. */
void photo_begin(photo_ahead *ahead, const photo_job *job);
/* Waits for the thread and gives the result to the caller; empty after a failure. */
status photo_finish(photo_ahead *ahead, photo_taken *out);

/* Does the same without a thread. */
status photo_take(const photo_job *job, photo_taken *out);

/* Estimates the photograph with these params, except for their hint and shot; it is empty afterwards. */
status photo_estimate(merlin_model *model, photo_taken *taken, const merlin_params *params, merlin_maps *maps);

/* Reads, finds and estimates; mask (then its own, or found) and params (then the defaults) may be NULL. Messages name
 * the photograph. */
status photo_maps(merlin_model *model, const char *photo, const char *mask, const merlin_params *params,
                  merlin_maps *maps);

#endif
