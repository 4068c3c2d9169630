/* SPDX-License-Identifier: MIT */
/* The object of a frame: by its mask, searched for, or followed. */
#ifndef MERLIN_SEQUENCE_SEQUENCE_OBJECT_H
#define MERLIN_SEQUENCE_SEQUENCE_OBJECT_H

#include <stdbool.h>

#include "base/status.h"
#include "merlin/sequences.h"

typedef struct object_request {
    const merlin_image *photo, *mask; /* mask: without data if none was given */
    const merlin_hint *hint;          /* for a search without a frame before; or NULL */
    const merlin_image *before;       /* where the object is expected; NULL: there is no frame before */
    bool was_given;                   /* that was given by a mask: a search would find another object */
} object_request;

/* Finds the object, and sets facts' object and overlap. confidence: that of the frame before, and then of this one. */
status sequence_object(const object_request *r, float *confidence, merlin_object *out, merlin_frame_facts *facts);

#endif
