/* SPDX-License-Identifier: MIT */
#include "base/text/json.h"

#include <cjson/cJSON.h>
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/text/json_parts.h"

static bool only_space(const char *text, const char *end)
{
    for (; text < end; text++)
        if (*text != ' ' && *text != '\t' && *text != '\n' && *text != '\r') return false;
    return true;
}

status json_parse(const char *text, size_t size, const char *where, json_object **out)
{
    *out = NULL;
    json_object *o = calloc(1, sizeof *o);
    if (!o) return fail(MERLIN_NO_MEMORY, "%s: out of memory", where);
    strncpy(o->where, where, JSON_WHERE - 1);
    const char *end = NULL;
    errno = 0;
    o->root = cJSON_ParseWithLengthOpts(text, size, &end, 0);
    status s = OK;
    if (!o->root && status_by_errno(MERLIN_BAD_INPUT) == MERLIN_NO_MEMORY) {
        s = fail(MERLIN_NO_MEMORY, "%s: out of memory", where);
    } else if (!o->root) {
        size_t at = end && end >= text ? (size_t)(end - text) : 0;
        s = fail(MERLIN_BAD_INPUT, "%s is not JSON (near byte %zu)", where, at);
    } else if (!cJSON_IsObject(o->root)) {
        s = fail(MERLIN_BAD_INPUT, "%s: the outermost value must be an object", where);
    } else if (!only_space(end, text + size)) {
        s = fail(MERLIN_BAD_INPUT, "%s: there is text behind the JSON object", where);
    }
    if (s != OK) {
        json_free(o);
        return s;
    }
    *out = o;
    return OK;
}

void json_free(json_object *o)
{
    if (!o) return;
    cJSON_Delete(o->root);
    free(o);
}

const char *json_where(const json_object *o)
{
    return o->where;
}

static status find(json_object *o, const char *key, const cJSON **out)
{
    *out = NULL;
    const cJSON *item;
    cJSON_ArrayForEach(item, o->root)
    {
        if (strcmp(item->string, key) != 0) continue;
        if (*out) return fail(MERLIN_BAD_INPUT, "%s: \"%s\" is given twice", o->where, key);
        *out = item;
    }
    if (!*out) return fail(MERLIN_BAD_INPUT, "%s: \"%s\" is missing", o->where, key);
    if (o->asked_count < JSON_KEYS) o->asked[o->asked_count++] = *out;
    return OK;
}

static status read_number(const json_object *o, const cJSON *item, const char *key, double low, double high,
                          double *out)
{
    if (!cJSON_IsNumber(item)) return fail(MERLIN_BAD_INPUT, "%s: \"%s\" must be a number", o->where, key);
    if (!(item->valuedouble >= low && item->valuedouble <= high))
        return fail(MERLIN_BAD_INPUT, "%s: \"%s\" must be between %g and %g", o->where, key, low, high);
    *out = item->valuedouble;
    return OK;
}

static status read_int(const json_object *o, const cJSON *item, const char *key, int low, int high, int *out)
{
    double value = 0;
    status s = read_number(o, item, key, low, high, &value);
    if (s != OK) return s;
    if (value != floor(value)) return fail(MERLIN_BAD_INPUT, "%s: \"%s\" must be a whole number", o->where, key);
    *out = (int)value;
    return OK;
}

status json_int(json_object *o, const char *key, int low, int high, int *out)
{
    const cJSON *item;
    status s = find(o, key, &item);
    return s == OK ? read_int(o, item, key, low, high, out) : s;
}

status json_number(json_object *o, const char *key, double low, double high, double *out)
{
    const cJSON *item;
    status s = find(o, key, &item);
    return s == OK ? read_number(o, item, key, low, high, out) : s;
}

bool json_has(const json_object *o, const char *key)
{
    const cJSON *item;
    cJSON_ArrayForEach(item, o->root)
    {
        if (strcmp(item->string, key) == 0) return true;
    }
    return false;
}

status json_number_or(json_object *o, const char *key, double low, double high, double fallback, double *out)
{
    if (json_has(o, key)) return json_number(o, key, low, high, out);
    *out = fallback;
    return OK;
}

status json_bool(json_object *o, const char *key, bool *out)
{
    const cJSON *item;
    status s = find(o, key, &item);
    if (s != OK) return s;
    if (!cJSON_IsBool(item)) return fail(MERLIN_BAD_INPUT, "%s: \"%s\" must be true or false", o->where, key);
    *out = cJSON_IsTrue(item) != 0;
    return OK;
}

status json_text(json_object *o, const char *key, char *out, size_t capacity)
{
    const cJSON *item;
    status s = find(o, key, &item);
    if (s != OK) return s;
    if (!cJSON_IsString(item)) return fail(MERLIN_BAD_INPUT, "%s: \"%s\" must be text", o->where, key);
    size_t length = strlen(item->valuestring);
    if (length == 0 || length >= capacity)
        return fail(MERLIN_BAD_INPUT, "%s: \"%s\" must have 1 to %zu characters", o->where, key, capacity - 1);
    memcpy(out, item->valuestring, length + 1);
    return OK;
}

status json_choice(json_object *o, const char *key, const char *const *words, int count, int *out)
{
    char text[32], list[256] = "";
    status s = json_text(o, key, text, sizeof text);
    if (s != OK) return s;
    for (int i = 0; i < count; i++) {
        if (strcmp(text, words[i]) == 0) {
            *out = i;
            return OK;
        }
        strncat(list, i ? ", " : "", sizeof list - strlen(list) - 1);
        strncat(list, words[i], sizeof list - strlen(list) - 1);
    }
    return fail(MERLIN_BAD_INPUT, "%s: \"%s\" must be one of: %s", o->where, key, list);
}

status json_ints(json_object *o, const char *key, int low, int high, int count, int *out)
{
    const cJSON *item;
    status s = find(o, key, &item);
    if (s != OK) return s;
    if (!cJSON_IsArray(item) || cJSON_GetArraySize(item) != count)
        return fail(MERLIN_BAD_INPUT, "%s: \"%s\" must be an array of %d numbers", o->where, key, count);
    const cJSON *element;
    cJSON_ArrayForEach(element, item)
    {
        s = read_int(o, element, key, low, high, out++);
        if (s != OK) return s;
    }
    return OK;
}

status json_ints_or(json_object *o, const char *key, int low, int high, int count, int fallback, int *out)
{
    if (json_has(o, key)) return json_ints(o, key, low, high, count, out);
    for (int i = 0; i < count; i++)
        out[i] = fallback;
    return OK;
}

status json_inner(json_object *o, const char *key, char **text)
{
    const cJSON *item;
    *text = NULL;
    status s = find(o, key, &item);
    if (s != OK) return s;
    if (!cJSON_IsObject(item)) return fail(MERLIN_BAD_INPUT, "%s: \"%s\" must be an object", o->where, key);
    *text = cJSON_PrintUnformatted(item);
    return *text ? OK : fail(MERLIN_NO_MEMORY, "%s: out of memory", o->where);
}

status json_finish(json_object *o)
{
    const cJSON *item;
    cJSON_ArrayForEach(item, o->root)
    {
        bool known = false;
        for (int i = 0; i < o->asked_count; i++)
            known = known || o->asked[i] == item;
        if (!known) return fail(MERLIN_BAD_INPUT, "%s: \"%s\" is not a known key", o->where, item->string);
    }
    return OK;
}
