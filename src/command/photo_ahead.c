/* SPDX-License-Identifier: MIT */
#include "command/photo_ahead.h"

#include <stdio.h>
#include <stdlib.h>

#include "base/progress.h"
#include "command/photo_folder.h"
#include "command/photo_hint.h"

/* mask: the job's, else alpha; without data if neither. */
static status read_both(const photo_job *job, merlin_image *photo, merlin_image *mask)
{
    merlin_status s = merlin_image_read(job->photo, photo, job->mask ? NULL : mask);
    if (s == MERLIN_OK && job->mask) s = merlin_mask_read(job->mask, mask);
    if (s != MERLIN_OK) merlin_image_free(photo);
    return (status)s;
}

status photo_read_object(const photo_job *job, merlin_image *photo, photo_object *object, double *read_seconds)
{
    merlin_image mask = {0};
    double began = clock_seconds();
    *photo = (merlin_image){0};
    *object = (photo_object){0};
    status s = read_both(job, photo, &mask);
    *read_seconds = clock_seconds() - began;
    if (s == OK) {
        s = photo_object_choose(photo, &mask, job->hint, object);
        (void)merlin_shot_read(job->photo, &object->shot);
        if (s != OK) s = fail_in(s, "%s", job->photo);
    }
    merlin_image_free(&mask);
    if (s != OK) merlin_image_free(photo);
    return s;
}

status photo_maps(merlin_model *model, const char *photo, const char *mask, const merlin_params *params,
                  const watch *shown, merlin_maps *maps)
{
    const merlin_hint *hint = params && photo_hint_given(&params->hint) ? &params->hint : NULL;
    char *own = NULL;
    status s = mask || hint ? OK : photo_own_mask(photo, &own);
    if (s != OK) return s;
    photo_job job = {.photo = (char *)photo, .mask = mask ? (char *)mask : own, .hint = hint};
    merlin_image picture;
    photo_object object;
    double seconds;
    watch_tell(shown, "reading", 0);
    s = photo_read_object(&job, &picture, &object, &seconds);
    free(own);
    if (s != OK) return s;
    object.watch = shown;
    s = estimate_object(model, &picture, &object, params, maps);
    return s == OK ? OK : fail_in(s, "%s", photo);
}

static void *read_photo(void *context)
{
    photo_ahead *ahead = context;
    double seconds;
    ahead->result = photo_read_object(ahead->job, &ahead->photo, &ahead->object, &seconds);
    if (ahead->result != OK) snprintf(ahead->message, sizeof ahead->message, "%s", status_message());
    return NULL;
}

void photo_begin(photo_ahead *ahead, const photo_job *job)
{
    *ahead = (photo_ahead){.job = job};
    ahead->running = pthread_create(&ahead->thread, NULL, read_photo, ahead) == 0;
}

status photo_finish(photo_ahead *ahead, merlin_image *photo, photo_object *object)
{
    if (ahead->running)
        pthread_join(ahead->thread, NULL);
    else
        read_photo(ahead);
    *photo = ahead->photo;
    *object = ahead->object;
    return ahead->result == OK ? OK : fail(ahead->result, "%s", ahead->message);
}
