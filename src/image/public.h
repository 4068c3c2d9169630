/* SPDX-License-Identifier: MIT */
/* Between the public headers' types and the inside's, which are laid out alike. */
#ifndef MERLIN_IMAGE_PUBLIC_H
#define MERLIN_IMAGE_PUBLIC_H

#include <stdbool.h>

#include "base/threads.h"
#include "image/image.h"
#include "merlin/merlin.h"

/* The same pixels under the other name; nothing is copied. */
static inline img img_of(const merlin_image *m)
{
    return (img){m->width, m->height, m->channels, m->data};
}

static inline merlin_image image_of(const img *m)
{
    return (merlin_image){m->width, m->height, m->channels, m->data};
}

static inline merlin_status result_of(status s)
{
    return (merlin_status)s;
}

/* Begins a public function: ERROR_USAGE where it got NULL for something that it needs. */
static inline status api_needs(const char *function, bool all_there)
{
    threads_begin();
    return all_there ? OK : fail(ERROR_USAGE, "%s was called with a null pointer", function);
}

#endif
