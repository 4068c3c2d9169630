#include "cli/photo_ahead.h"

#include <stdio.h>

#include "base/progress.h"

status photo_read_object(const photo_job *job, merlin_image *photo, photo_object *object, double *read_seconds)
{
    merlin_image mask = {0};
    double began = clock_seconds();
    *photo = (merlin_image){0};
    *object = (photo_object){0};
    status s = photo_read(job, photo, &mask);
    *read_seconds = clock_seconds() - began;
    if (s == OK) {
        s = photo_object_choose(photo, &mask, object);
        if (s != OK) s = fail_in(s, "%s", job->photo);
    }
    merlin_image_free(&mask);
    if (s != OK) merlin_image_free(photo);
    return s;
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
