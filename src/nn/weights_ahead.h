/* SPDX-License-Identifier: MIT */
/* Converts a program's copies of its parameters in a thread of its own while later steps are still being bound.
 *
 *     weights_ahead a;
 *     weights_ahead_begin(&a, program);
 *     ... bind a step; weights_ahead_bound(&a, steps bound so far); ...
 *     s = weights_ahead_end(&a, s);
 *
 * Only for parameters that do not change before the first run. Internal to src/nn. */
#ifndef MERLIN_NN_WEIGHTS_AHEAD_H
#define MERLIN_NN_WEIGHTS_AHEAD_H

#include <pthread.h>
#include <stdbool.h>

#include "nn/nn_program.h"

typedef struct weights_ahead {
    nn_program *program;
    pthread_t thread;
    pthread_mutex_t lock; /* guards the fields below */
    pthread_cond_t changed;
    bool running, ended;
    int bound;
    status result;
    char message[1024];
} weights_ahead;

/* Starts the thread; if none can be started, the program's first run makes the copies. */
void weights_ahead_begin(weights_ahead *a, nn_program *program);
void weights_ahead_bound(weights_ahead *a, int steps);
/* Waits for the copies, or cancels them if `so_far` is not OK. Returns the first failure. */
status weights_ahead_end(weights_ahead *a, status so_far);

#endif
