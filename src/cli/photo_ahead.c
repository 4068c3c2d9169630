#include "cli/photo_ahead.h"

#include <stdio.h>

static void *read_photo(void *context)
{
    photo_ahead *ahead = context;
    ahead->result = photo_read(ahead->job, &ahead->photo, &ahead->mask);
    if (ahead->result != OK) snprintf(ahead->message, sizeof ahead->message, "%s", status_message());
    return NULL;
}

void photo_begin(photo_ahead *ahead, const photo_job *job)
{
    *ahead = (photo_ahead){.job = job};
    ahead->running = pthread_create(&ahead->thread, NULL, read_photo, ahead) == 0;
}

status photo_finish(photo_ahead *ahead, merlin_image *photo, merlin_image *mask)
{
    if (ahead->running)
        pthread_join(ahead->thread, NULL);
    else
        read_photo(ahead);
    *photo = ahead->photo;
    *mask = ahead->mask;
    return ahead->result == OK ? OK : fail(ahead->result, "%s", ahead->message);
}
