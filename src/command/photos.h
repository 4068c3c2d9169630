/* SPDX-License-Identifier: MIT */
/* What estimate and relight share: which photographs, their masks, where results go, and where the weights are. */
#ifndef MERLIN_COMMAND_PHOTOS_H
#define MERLIN_COMMAND_PHOTOS_H

#include <cJSON.h>
#include <stdbool.h>
#include <stddef.h>

#include "base/status.h"
#include "command/photo_list.h"

/* One photograph goes to `output`, by default its name without ending + ".merlin". Several, or a folder's, each go to a
 * folder of their own inside `output`, by default beside them. `mask` is one photograph's, or a folder of masks for
 * several; without it a photograph's mask is what lies beside it under one of a mask's usual names (docs/pictures.md).
 */
status photo_list_make(char *const *arguments, int count, const char *mask, const char *output, photo_list *out);

/* One of so many shares of a list, counted from 1. */
typedef struct photo_share {
    size_t which, of;
} photo_share;
/* Keeps every N-th alone. Where results go does not depend on it. */
void photo_list_share(photo_list *list, const photo_share *share);
/* Drops the photographs whose maps are there and not older than photograph and mask; returns how many. */
size_t photo_list_drop_done(photo_list *list);
/* Prints one line for each folder that something was left aside of. */
void photo_list_tell(const photo_list *list, const char *command);
/* Adds to a photograph's report what was left aside of all folders, if anything was. */
void photo_list_put(const photo_list *list, cJSON *report);
/* Has the object searched for by a hint, which is borrowed, in place of taking the mask that lies beside it. */
void photo_use_hint(photo_job *job, const merlin_hint *hint);
void photo_list_free(photo_list *list);

/* Where what is made of a photograph, or of a folder, goes: asked if that is not NULL, else NAME inside the folder or
 * inside the photograph's own, its name without ending + ".merlin"; malloc'ed. */
char *photo_output_inside(const char *input, const char *name, const char *asked);
/* input, or of DIR/maps.exr, which is cut, DIR: shells complete the name of what stands in a folder of maps, and the
 * folder is meant. */
const char *photo_without_maps_name(char *input);

/* asked, else $MERLIN_MODEL, else merlin-point: a file, or the name of weights that merlin ships. Those are in models
 * beside the program or above it (a build folder in the source tree), else in share/merlin/models; *path is malloc'ed.
 */
status photo_find_model(const char *asked, char **path);
/* Finds the weights for photographs of any light: as photo_find_model does, but merlin-any where nothing is asked and
 * it is there, and then *flash is merlin-point, for those that it sees lit by a flash alone; else *flash is NULL. Both
 * are malloc'ed. */
status photo_find_models(const char *asked, char **path, char **flash);

/* Opens what photo_find_models found; flash may be NULL. */
status photo_open_models(const char *path, const char *flash, merlin_model **out);

/* The values of --size, and of --exposure ("auto" or EV), for a row of command/options.h; into is a merlin_params. */
status photo_take_size(const char *text, void *into);
/* "K/N" of --share; into is a photo_share. */
status photo_take_share(const char *text, void *into);
status photo_take_exposure(const char *text, void *into);
/* Whether --size, --views, --exposure, --point or --box ask for anything but the defaults. */
bool photo_params_given(const merlin_params *params);
/* MERLIN_WRONG_USE where these options go with a folder of maps, which is not estimated again; mask may be NULL. */
status photo_check_maps(const char *folder, const char *mask, const merlin_params *params);

#endif
