/* SPDX-License-Identifier: MIT */
/* JSON that is put together by cJSON, and from which nothing goes missing without a word: where memory runs out, what
 * lacks a value is marked, and there is no text of it.
 *
 *     cJSON *o = cJSON_CreateObject();
 *     json_put_number(o, "gain", 2);
 *     json_append(json_put_array(o, "lights"), cJSON_CreateNumber(3));
 *     char *text = json_print(o);      NULL if memory ran out anywhere
 *     cJSON_Delete(o);
 *
 * Each takes NULL for what it puts into and then does nothing, for whatever that should have stood in is marked. */
#ifndef MERLIN_BASE_JSON_JSON_PUT_H
#define MERLIN_BASE_JSON_JSON_PUT_H

#include <stdbool.h>

#include <cJSON.h>

void json_put_number(cJSON *to, const char *key, double number);
void json_put_bool(cJSON *to, const char *key, bool is);
/* Bytes that are not UTF-8 become U+FFFD, which a file's name may have. */
void json_put_text(cJSON *to, const char *key, const char *text);
cJSON *json_put_object(cJSON *to, const char *key);
cJSON *json_put_array(cJSON *to, const char *key);
cJSON *json_append_object(cJSON *to);

/* Take over the item, which is not to be touched any more: NULL is one that there was no memory for. */
void json_put_item(cJSON *to, const char *key, cJSON *item);
void json_append(cJSON *to, cJSON *item);
void json_append_text(cJSON *to, const char *text);

/* malloc'ed; NULL if memory runs out, or ran out while it was put together. The latter on one line. */
char *json_print(const cJSON *root);
char *json_print_line(const cJSON *root);

#endif
