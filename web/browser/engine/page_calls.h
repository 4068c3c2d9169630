/* SPDX-License-Identifier: MIT */
/* Calls between the page's worker (web/browser/engine.js) and libmerlin's estimate of one
 * photograph at a time, whose networks the browser runs. Texts are UTF-8, ended by a zero; pictures have 8 bits. */
#ifndef MERLIN_BROWSER_PAGE_CALLS_H
#define MERLIN_BROWSER_PAGE_CALLS_H

#include <stddef.h>
#include <stdint.h>

/* ---- what the worker implements ---- */

/* Takes a file's bytes, which it copies. */
void page_file(const char *name, const void *data, size_t size);

/* ---- what it calls ---- */

/* Return memory for the worker's arguments, and free it; NULL without memory. */
void *page_alloc(size_t size);
void page_free(void *memory);
/* Return the library's version, and the last error's words. */
const char *page_version(void);
const char *page_error(void);

/* Adds an input or output of a network (recorded_networks.h); returns a status, as all that follow do unless they say
 * otherwise. */
int page_network(const char *network, const char *name, int channels, int reduction, int is_input);
/* Opens the model for any light, and the one for flashes. */
int page_open(const char *any, const char *flash);

/* Takes a photograph: rgba of width × height in sRGB, and the file's bytes, whose EXIF tells lens and flash. An alpha
 * that is not opaque is its mask. */
int page_photo(const uint8_t *rgba, int width, int height, const uint8_t *file, size_t size);
/* Returns the focal length on 36 × 24 mm of the photograph's EXIF; 0: unknown. */
float page_focal(void);
/* Finds the object, or takes alpha's. */
int page_find(void);
/* Takes a mask of the photograph's size, a byte a pixel. */
int page_set_mask(const uint8_t *mask);
/* Writes the mask, a byte a pixel. */
int page_get_mask(uint8_t *mask);
/* Returns the probability that the mask that was found is right; 1 for a given one. */
float page_confidence(void);

/* Begins an estimate: horizontal field of view in degrees (0: by EXIF), whether a flash is known to be the only light,
 * the network's size and views as in merlin_params. */
int page_begin(float fov, int flash, int size, int views);
/* Goes on with it: 0 once the maps are there, MERLIN_STOPPED if a network is to be run, else what failed. */
int page_step(void);
/* Tell about the run that is wanted: its network ("": none is, and the others must not be called), how many inputs or
 * outputs it has, and of each the name, the channels, the side, and the data, which of an output the worker fills. */
const char *page_run_network(void);
int page_run_count(int is_input);
const char *page_run_name(int is_input, int i);
int page_run_channels(int is_input, int i);
int page_run_side(int is_input, int i);
float *page_run_data(int is_input, int i);
/* Records what the worker has filled in. */
void page_answered(void);

/* Hands the maps to page_file: as merlin estimate's files, without the overview, and as viewer.html under this name. */
int page_write(const char *name);

#endif
