/* SPDX-License-Identifier: MIT */
/* Builds JSON with cJSON so that a lack of memory is never silent: an object that lacks a value is marked, and cannot
 * be printed.
 *
 *     cJSON *o = cJSON_CreateObject();
 *     json_put_number(o, "gain", 2);
 *     json_append(json_put_array(o, "lights"), cJSON_CreateNumber(3));
 *     char *text = json_print(o);      NULL if memory ran out anywhere
 *     cJSON_Delete(o);
 *
 * Every function accepts NULL for the parent and then does nothing, as what the parent should have been added to is
 * marked. */
#ifndef MERLIN_BASE_JSON_JSON_PUT_H
#define MERLIN_BASE_JSON_JSON_PUT_H

#include <stdbool.h>

#include <cjson/cJSON.h>

void json_put_number(cJSON *to, const char *key, double number);
void json_put_bool(cJSON *to, const char *key, bool is);
/* Adds a text. Bytes that are not UTF-8, as a file's name may have, become U+FFFD. */
void json_put_text(cJSON *to, const char *key, const char *text);
cJSON *json_put_object(cJSON *to, const char *key);
cJSON *json_put_array(cJSON *to, const char *key);
cJSON *json_append_object(cJSON *to);

/* Add an item and take it over: the caller must not use it afterwards. NULL is an item for which there was no memory.
 */
void json_put_item(cJSON *to, const char *key, cJSON *item);
void json_append(cJSON *to, cJSON *item);
void json_append_text(cJSON *to, const char *text);

/* Return the object as text, malloc'ed, json_print_line on one line; NULL if memory ran out, now or while it was built.
 */
char *json_print(const cJSON *root);
char *json_print_line(const cJSON *root);

#endif
