/* SPDX-License-Identifier: MIT */
#include "base/json/json_put.h"

#include <stdlib.h>

#include "base/json/utf8.h"

/* Mark of an incomplete item: a bit of its type beyond the lowest ten, which cJSON uses. */
enum { LACKS = 1 << 16 };

void json_put_item(cJSON *to, const char *key, cJSON *item)
{
    if (to && item && cJSON_AddItemToObject(to, key, item)) return;
    cJSON_Delete(item);
    if (to) to->type |= LACKS;
}

void json_append(cJSON *to, cJSON *item)
{
    if (to && item && cJSON_AddItemToArray(to, item)) return;
    cJSON_Delete(item);
    if (to) to->type |= LACKS;
}

void json_put_number(cJSON *to, const char *key, double number)
{
    json_put_item(to, key, cJSON_CreateNumber(number));
}

void json_put_bool(cJSON *to, const char *key, bool is)
{
    json_put_item(to, key, cJSON_CreateBool(is));
}

static cJSON *text_item(const char *text)
{
    char *valid = utf8_valid(text);
    cJSON *item = valid ? cJSON_CreateString(valid) : NULL;
    free(valid);
    return item;
}

void json_put_text(cJSON *to, const char *key, const char *text)
{
    json_put_item(to, key, text_item(text));
}

void json_append_text(cJSON *to, const char *text)
{
    json_append(to, text_item(text));
}

/* Returns the item that was just added; NULL if the parent lacks a value. */
static cJSON *put(const cJSON *to, cJSON *item)
{
    return to && !(to->type & LACKS) ? item : NULL;
}

cJSON *json_put_object(cJSON *to, const char *key)
{
    cJSON *item = cJSON_CreateObject();
    json_put_item(to, key, item);
    return put(to, item);
}

cJSON *json_put_array(cJSON *to, const char *key)
{
    cJSON *item = cJSON_CreateArray();
    json_put_item(to, key, item);
    return put(to, item);
}

cJSON *json_append_object(cJSON *to)
{
    cJSON *item = cJSON_CreateObject();
    json_append(to, item);
    return put(to, item);
}

static bool is_whole(const cJSON *item)
{
    if (item->type & LACKS) return false;
    for (const cJSON *inner = item->child; inner; inner = inner->next)
        if (!is_whole(inner)) return false;
    return true;
}

char *json_print(const cJSON *root)
{
    return root && is_whole(root) ? cJSON_Print(root) : NULL;
}

char *json_print_line(const cJSON *root)
{
    return root && is_whole(root) ? cJSON_PrintUnformatted(root) : NULL;
}
