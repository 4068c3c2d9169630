/* SPDX-License-Identifier: MIT */
/* JSON files that refer to others, so that common settings are written once.
 *
 *     {"base": "01-96.json", "training": {"seed": 42}}                             01-96.json with another seed
 *     {"base": "../a/9.json", "model": "../models/small.json"}                     9.json with another model
 *
 * The keys of the file named by "base" are inherited; where both files have a key, objects are merged key by key and
 * anything else, arrays too, is replaced. A path in place of an object stands for that file's object, and replaces the
 * base's entirely. Paths are relative to the file that they are written in, and each of these files may refer to
 * others. */
#ifndef MERLIN_BASE_TEXT_JSON_FILE_H
#define MERLIN_BASE_TEXT_JSON_FILE_H

#include "base/text/json.h"

/* Most files that may refer to each other in a chain, the first one included. */
enum { JSON_FILES_DEEP = 8 };

/* Reads a file with everything that it refers to; messages about its content mention the other files if there are any.
 * part: the key whose object may be a path, or NULL. Circles, chains of more than JSON_FILES_DEEP files and duplicate
 * keys are refused. */
status json_file_read(const char *path, const char *part, json_object **out);

#endif
