/* SPDX-License-Identifier: MIT */
/* JSON files that name others, so that what many have in common stands in one of them.
 *
 *     {"base": "01-96.json", "training": {"seed": 42}}                             01-96.json with another seed
 *     {"base": "../a/9.json", "model": "../models/small.json"}                     9.json with another model
 *
 * The keys of the file that "base" names are as if they stood here; where both have one, objects are merged key by key
 * and anything else, arrays too, is this file's. Where a file has the path of another instead of an object, it has that
 * file's object, and nothing of the base's. Paths go from the folder of the file that they stand in, and any of these
 * files may name others. */
#ifndef MERLIN_BASE_TEXT_JSON_FILE_H
#define MERLIN_BASE_TEXT_JSON_FILE_H

#include "base/text/json.h"

/* Number of files that may stand on one another, the first among them. */
enum { JSON_FILES_DEEP = 8 };

/* A file with all that it names put in; messages about what is read of it say when there are other files to look in.
 * part: the key whose object may be a path, or NULL. Circles, more than JSON_FILES_DEEP files on one another, and
 * keys given twice are refused. */
status json_file_read(const char *path, const char *part, json_object **out);

#endif
