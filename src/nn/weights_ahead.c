/* SPDX-License-Identifier: MIT */
#include "nn/weights_ahead.h"

#include <stdio.h>

#include "base/threads.h"

/* Waits until more than `done` steps are bound, and returns how many; returns `done` if there will be no more. */
static int wait_for_more(weights_ahead *a, int done)
{
    pthread_mutex_lock(&a->lock);
    while (a->bound <= done && !a->ended)
        pthread_cond_wait(&a->changed, &a->lock);
    int bound = a->bound;
    pthread_mutex_unlock(&a->lock);
    return bound;
}

static status refresh_steps(weights_ahead *a)
{
    int done = 0, bound;
    while ((bound = wait_for_more(a, done)) > done)
        for (; done < bound; done++) {
            status s = program_refresh_step(&a->program->steps[done]);
            if (s != OK) return s;
        }
    return OK;
}

static void *refresh(void *context)
{
    weights_ahead *a = context;
    const nn_device *device = a->program->device;
    threads_use_here(1); /* one thread only: the other processors are busy */
    device->begin(a->program->context);
    a->result = refresh_steps(a);
    device->end(a->program->context);
    if (a->result != OK) snprintf(a->message, sizeof a->message, "%s", status_message());
    return NULL;
}

void weights_ahead_begin(weights_ahead *a, nn_program *program)
{
    *a = (weights_ahead){
        .program = program, .lock = PTHREAD_MUTEX_INITIALIZER, .changed = PTHREAD_COND_INITIALIZER, .result = OK};
    a->running = pthread_create(&a->thread, NULL, refresh, a) == 0;
}

static void tell(weights_ahead *a, int bound, bool ended)
{
    pthread_mutex_lock(&a->lock);
    a->bound = bound;
    a->ended = ended;
    pthread_cond_signal(&a->changed);
    pthread_mutex_unlock(&a->lock);
}

void weights_ahead_bound(weights_ahead *a, int steps)
{
    if (a->running) tell(a, steps, false);
}

status weights_ahead_end(weights_ahead *a, status so_far)
{
    if (!a->running) return so_far;
    tell(a, so_far == OK ? a->bound : 0, true);
    pthread_join(a->thread, NULL);
    if (so_far != OK) return so_far;
    if (a->result != OK) return fail(a->result, "%s", a->message);
    a->program->version = a->program->params->version;
    return OK;
}
