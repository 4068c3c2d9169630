/* SPDX-License-Identifier: MIT */
/* The contents of the files that samples are made of, as lines of text that change when they do:
 *
 *     char *lines;
 *     status s = contents_describe(&options, &lines);     "contents of mesh 85ebca6bc2b2ae35\n", malloc'ed
 *
 * So a set is not continued with another mesh of the same name. */
#ifndef MERLIN_LAB_RENDER_CONTENTS_H
#define MERLIN_LAB_RENDER_CONTENTS_H

#include "lab/render/render_options.h"

/* Describes the mesh and the folders that the options name, these by names and bytes of all files that are read, in any
 * order. Empty where they name none; MERLIN_BAD_INPUT for what cannot be read. */
status contents_describe(const render_options *options, char **lines);

#endif
