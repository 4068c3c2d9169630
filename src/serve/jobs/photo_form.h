/* SPDX-License-Identifier: MIT */
/* A client's photograph with its mask, and the options of its estimate: the fields "photo", "mask", "point", "box",
 * "size", "views", "fov", "flash" and "exposure". */
#ifndef MERLIN_SERVE_JOBS_PHOTO_FORM_H
#define MERLIN_SERVE_JOBS_PHOTO_FORM_H

#include "serve/jobs/work.h"

/* Their rows for form_check. */
#define PHOTO_HINT_KEYS                                                                                                \
    {"photo", FORM_FILE, 1}, {"point", FORM_VALUE, MERLIN_MOST_POINTS},                                                \
    {                                                                                                                  \
        "box", FORM_VALUE, 1                                                                                           \
    }
#define PHOTO_KEYS                                                                                                     \
    PHOTO_HINT_KEYS, {"mask", FORM_FILE, 1}, {"size", FORM_VALUE, 1}, {"views", FORM_VALUE, 1},                        \
        {"fov", FORM_VALUE, 1}, {"flash", FORM_VALUE, 1},                                                              \
    {                                                                                                                  \
        "exposure", FORM_VALUE, 1                                                                                      \
    }

/* Reads the values; params.hint is that of point and box. */
status photo_form_params(const form *f, merlin_params *params);
/* Reads those of them that say how a model sees pictures, too: point, box, size and views. */
status photo_form_seeing(const form *f, merlin_params *params);
/* Refuses the fields of a photograph for `what`, which has none. */
status photo_form_refuse(const form *f, const char *what);
status photo_form_hint(const form *f, merlin_hint *hint);

/* Reads the photograph and finds its object: by the client's mask, which may be smaller than the photograph, else by
 * its alpha, else by the hint. Both are empty after a failure. */
status photo_form_read(const work_context *w, const merlin_hint *hint, merlin_image *photo, merlin_object *object);
/* Does the same, and estimates its maps. */
status photo_form_estimate(const work_context *w, const merlin_params *params, merlin_maps *maps);

#endif
