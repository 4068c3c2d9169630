/* SPDX-License-Identifier: MIT */
/* Strict reading of JSON configuration: every key is asked for by name and type, and keys that were not asked for are
 * refused.
 *
 *     json_object *o;
 *     status s = json_parse(text, size, "train.json", &o);
 *     int batch;
 *     if (s == OK) s = json_int(o, "batch", 1, 1024, &batch);
 *     if (s == OK) s = json_finish(o);      names the first key that was never asked for
 *     json_free(o);
 *
 * Messages say which file and which key. */
#ifndef MERLIN_BASE_TEXT_JSON_H
#define MERLIN_BASE_TEXT_JSON_H

#include <stdbool.h>
#include <stddef.h>

#include "base/status.h"

typedef struct json_object json_object;

/* Parses a text that must be one JSON object and nothing after it. `where` is put in front of messages. */
status json_parse(const char *text, size_t size, const char *where, json_object **out);
void json_free(json_object *o);
/* Returns the words that are put in front of messages about this object. */
const char *json_where(const json_object *o);

bool json_has(const json_object *o, const char *key);

/* Read a required value; each fails if the key is missing, given twice, of another type or outside the inclusive range.
 */
status json_int(json_object *o, const char *key, int low, int high, int *out);
status json_number(json_object *o, const char *key, double low, double high, double *out);
status json_bool(json_object *o, const char *key, bool *out);
status json_text(json_object *o, const char *key, char *out, size_t capacity);
/* Reads one of `count` words; *out is its index. */
status json_choice(json_object *o, const char *key, const char *const *words, int count, int *out);
/* Reads an optional number; *out is fallback if it is missing. */
status json_number_or(json_object *o, const char *key, double low, double high, double fallback, double *out);
/* Reads an array of exactly `count` integers. */
status json_ints(json_object *o, const char *key, int low, int high, int count, int *out);
/* Reads an optional array; all elements are fallback if it is missing. */
status json_ints_or(json_object *o, const char *key, int low, int high, int count, int fallback, int *out);
/* Returns the text of an object inside this one, malloc'ed. */
status json_inner(json_object *o, const char *key, char **text);

/* Refuses keys that were not asked for. */
status json_finish(json_object *o);

#endif
