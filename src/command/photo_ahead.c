/* SPDX-License-Identifier: MIT */
#include "command/photo_ahead.h"

#include <stdio.h>
#include <stdlib.h>

#include "base/progress.h"
#include "command/photo_folder.h"
#include "command/photo_hint.h"

void photo_taken_free(photo_taken *taken)
{
    merlin_image_free(&taken->photo);
    merlin_object_free(&taken->object);
}

/* Reads both. mask: the job's, else alpha; without data if there is neither. */
static status read_both(const photo_job *job, merlin_image *photo, merlin_image *mask)
{
    status s = merlin_image_read(job->photo, photo, job->mask ? NULL : mask);
    if (s == OK && job->mask) s = merlin_mask_read(job->mask, mask);
    return s;
}

status photo_take(const photo_job *job, photo_taken *out)
{
    merlin_image mask = {0};
    double began = clock_seconds();
    *out = (photo_taken){.read_seconds = 0};
    status s = read_both(job, &out->photo, &mask);
    out->read_seconds = clock_seconds() - began;
    if (s == OK) {
        merlin_hint hint = job->hint ? *job->hint : (merlin_hint){.point_count = 0};
        (void)merlin_shot_read(job->photo, &out->shot);
        hint.reduced = out->shot.reduced;
        s = merlin_object_find(&out->photo, &mask, &hint, &out->object);
        if (s != OK) s = fail_in(s, "%s", job->photo);
    }
    merlin_image_free(&mask);
    if (s != OK) photo_taken_free(out);
    return s;
}

status photo_estimate(merlin_model *model, photo_taken *taken, const merlin_params *params, merlin_maps *maps)
{
    merlin_params own = params ? *params : merlin_params_default();
    own.shot = taken->shot;
    return merlin_estimate_object(model, &taken->photo, &taken->object, &own, maps);
}

status photo_maps(merlin_model *model, const char *photo, const char *mask, const merlin_params *params,
                  merlin_maps *maps)
{
    const merlin_hint *hint = params && photo_hint_given(&params->hint) ? &params->hint : NULL;
    char *own = NULL;
    status s = mask || hint ? OK : photo_own_mask(photo, &own);
    if (s != OK) return s;
    photo_job job = {.photo = (char *)photo, .mask = mask ? (char *)mask : own, .hint = hint};
    photo_taken taken;
    if (params && params->progress) params->progress(params->progress_context, "reading", 0);
    s = photo_take(&job, &taken);
    free(own);
    if (s != OK) return s;
    s = photo_estimate(model, &taken, params, maps);
    return s == OK ? OK : fail_in(s, "%s", photo);
}

static void *take(void *context)
{
    photo_ahead *ahead = context;
    ahead->result = photo_take(ahead->job, &ahead->taken);
    if (ahead->result != OK) snprintf(ahead->message, sizeof ahead->message, "%s", status_message());
    return NULL;
}

void photo_begin(photo_ahead *ahead, const photo_job *job)
{
    *ahead = (photo_ahead){.job = job};
    ahead->running = pthread_create(&ahead->thread, NULL, take, ahead) == 0;
}

status photo_finish(photo_ahead *ahead, photo_taken *out)
{
    if (ahead->running)
        pthread_join(ahead->thread, NULL);
    else
        take(ahead);
    *out = ahead->taken;
    return ahead->result == OK ? OK : fail(ahead->result, "%s", ahead->message);
}
