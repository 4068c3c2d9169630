/* libvips, started once, silent, and without the caches and threads that a command reading a few files does not need.
 */
#ifndef MERLIN_IMAGE_START_H
#define MERLIN_IMAGE_START_H

#include "base/status.h"

status vips_begin(void);

/* "cannot VERB PATH: the library's first words" with status s; forgets the library's words. */
status vips_refusal(status s, const char *verb, const char *path);

#endif
