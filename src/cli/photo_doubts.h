/* What a person should know of a photograph before they trust what was made of it. */
#ifndef MERLIN_CLI_PHOTO_DOUBTS_H
#define MERLIN_CLI_PHOTO_DOUBTS_H

#include "merlin/merlin.h"

/* A line each to standard error: the object was found with little confidence; a tenth of it or more is burnt out.
 * folder: where the mask can be looked at; NULL: nowhere. */
void photo_doubts_print(const char *command, const char *photo, const merlin_maps *maps, const char *folder);

#endif
