/* What reading and writing EXR share: an OpenEXR Core context that never prints, its first complaint kept for a status
 * message. */
#ifndef MERLIN_IMAGE_EXR_CONTEXT_H
#define MERLIN_IMAGE_EXR_CONTEXT_H

#include <OpenEXR/openexr.h>

#include "base/status.h"

typedef struct exr_complaint {
    char text[256];
} exr_complaint;

/* An initializer whose errors go to *complaint, which must outlive the context. */
exr_context_initializer_t exr_quiet(exr_complaint *complaint);

/* "cannot VERB PATH: the library's words" with status s. */
status exr_fail(status s, const char *verb, const char *path, const exr_complaint *complaint, exr_result_t code);

#endif
