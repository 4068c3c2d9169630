/* SPDX-License-Identifier: MIT */
/* Functions shared by estimate and relight: lists of photographs, their masks, places of results, and of weights. */
#ifndef MERLIN_COMMAND_PHOTOS_H
#define MERLIN_COMMAND_PHOTOS_H

#include <cjson/cJSON.h>
#include <stdbool.h>
#include <stddef.h>

#include "base/status.h"
#include "command/photo_list.h"
#include "command/photo_source.h"
#include "merlin/stereo.h"

/* Makes the list. The results of one photograph go to `output`, by default its name without ending + ".merlin".
 * Several, or a folder's, each have a folder of their own inside `output`, by default next to them. `mask` is one
 * photograph's, or a folder of masks for several; without it a photograph's mask is a file next to it with a usual name
 * (docs/pictures.md). */
status photo_list_make(char *const *arguments, int count, const char *mask, const char *output, photo_list *out);

/* One of several shares of a list, counted from 1. */
typedef struct photo_share {
    size_t which, of;
} photo_share;
/* Keeps only every N-th photograph. The places of results do not depend on it. */
void photo_list_share(photo_list *list, const photo_share *share);
/* Files that a photograph is to have: names inside its folder, ended by NULL, and paths elsewhere. */
typedef struct photo_wanted {
    const char *const *inside, *const *elsewhere;
    size_t count; /* of those elsewhere */
    photo_how how;
} photo_wanted;
/* Removes photographs that have all of these files, none of them older than photograph and mask, and made of these and
 * by the same options (photo_source.h); returns their number. */
size_t photo_list_drop_done(photo_list *list, const photo_wanted *wanted);
/* Prints one line for each folder with skipped files. */
void photo_list_tell(const photo_list *list, const char *command);
/* Adds the skipped files of all folders to a photograph's report, if there are any. */
void photo_list_put(const photo_list *list, cJSON *report);
/* Makes the object be searched for with a hint, which is borrowed, instead of using the mask next to the photograph. */
void photo_use_hint(photo_job *job, const merlin_hint *hint);
void photo_list_free(photo_list *list);

/* Returns the place of results of a photograph or folder: `asked` if that is not NULL, else NAME inside the folder or
 * inside the photograph's own folder, its name without ending + ".merlin"; malloc'ed. */
char *photo_output_inside(const char *input, const char *name, const char *asked);
/* Returns input, or for DIR/maps.exr and DIR/report.json, which are cut, DIR: shells complete the name of a file in a
 * folder of maps, and the folder is meant. */
const char *photo_without_maps_name(char *input);
/* Takes a command's one photograph or folder from its arguments: "-" is standard input, which has no name and so wants
 * an `output`, and DIR/maps.exr is DIR. *input lives as long as the argument. */
status photo_take_input(char **argument, const char *output, const char **input);

/* Finds `asked`, else $MERLIN_MODEL, else merlin-point: a file, or the name of weights that merlin ships. Those are in
 * models next to the program or above it (a build folder in the source tree), else in share/merlin/models; *path is
 * malloc'ed. */
status photo_find_model(const char *asked, char **path);
/* Finds the weights for photographs in any light: as photo_find_model does, but merlin-any by default if it exists, and
 * then *flash is merlin-point, for photographs that it considers lit by a flash alone; else *flash is NULL. Both are
 * malloc'ed. */
status photo_find_models(const char *asked, char **path, char **flash);
/* Finds the weights to relight maps with: the same, but by default those that made the maps, if it is other ones that
 * ship. */
status photo_find_models_of(const merlin_maps *maps, const char *asked, char **path, char **flash);

/* Finds weights that see several photographs together, by a name or a path; asked NULL: merlin-several, where it is
 * there, else *path is NULL. malloc'ed. */
status photo_find_several(const char *asked, char **path);

/* Opens a network of near lights (merlin/stereo.h), of weights by a name or a path; asked NULL: merlin-nfps. Where that
 * is not there *out is NULL, and MERLIN_BAD_INPUT if it is needed. */
status photo_open_near(const char *asked, bool needed, merlin_near_network **out);

/* Adds merlin-several, where it is there, to a model of weights that were not chosen; flash: what photo_find_models
 * found, NULL of chosen weights, which stand alone. */
status photo_add_several(const char *flash, merlin_model *model);

/* Opens the result of photo_find_models; flash may be NULL. */
status photo_open_models(const char *path, const char *flash, merlin_model **out);

/* Take the values of --size, and of --exposure ("auto" or EV), for a row of command/options.h; into is a merlin_params.
 */
status photo_take_size(const char *text, void *into);
/* Takes "K/N" of --share; into is a photo_share. */
status photo_take_share(const char *text, void *into);
status photo_take_exposure(const char *text, void *into);
/* Tells whether --size, --views, --exposure, --point or --box differ from the defaults. */
bool photo_params_given(const merlin_params *params);
/* Fails with MERLIN_WRONG_USE if these options are combined with a folder of maps, which is not estimated again; mask
 * may be NULL. */
status photo_check_maps(const char *folder, const char *mask, const merlin_params *params);

#endif
