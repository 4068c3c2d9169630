/* SPDX-License-Identifier: MIT */
/* Checksums of the files from which samples are made, as lines of text:
 *
 *     char *lines;
 *     status s = contents_describe(&options, &lines);     "contents of mesh 85ebca6bc2b2ae35\n", malloc'ed
 *
 * A data set can thus not be continued with another mesh of the same name. */
#ifndef MERLIN_LAB_RENDER_CONTENTS_H
#define MERLIN_LAB_RENDER_CONTENTS_H

#include "lab/render/render_options.h"

/* Describes the mesh and the folders that the options name, folders by names and bytes of all files that are read, in
 * any order. Empty if none is named; MERLIN_BAD_INPUT if a file cannot be read. */
status contents_describe(const render_options *options, char **lines);

#endif
