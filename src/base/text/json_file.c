/* SPDX-License-Identifier: MIT */
#include "base/text/json_file.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/text/json_parts.h"

enum { MAX_BYTES = 1 << 20 };

/* A file on the path from the one that was asked for to the one being read. */
typedef struct link {
    const char *path, *key; /* key: under which its parent names it */
    const struct link *parent;
} link;

static status check_way(const link *at)
{
    int deep = 1;
    for (const link *above = at->parent; above; above = above->parent) {
        if (file_is_same(above->path, at->path))
            return fail(MERLIN_BAD_INPUT, "%s: \"%s\" leads in a circle, back to %s", at->parent->path, at->key,
                        above->path);
        if (++deep > JSON_FILES_DEEP)
            return fail(MERLIN_BAD_INPUT, "%s: \"%s\" would be the %dth file on one another, %d may be",
                        at->parent->path, at->key, deep, JSON_FILES_DEEP);
    }
    return OK;
}

static status check_once(const json_object *o, const cJSON *object)
{
    const cJSON *item;
    cJSON_ArrayForEach(item, object)
    {
        for (const cJSON *other = item->next; other; other = other->next)
            if (strcmp(item->string, other->string) == 0)
                return fail(MERLIN_BAD_INPUT, "%s: \"%s\" is given twice", o->where, item->string);
        status s = cJSON_IsObject(item) ? check_once(o, item) : OK;
        if (s != OK) return s;
    }
    return OK;
}

static status open_file(const link *at, json_object **out)
{
    char *text = NULL;
    size_t size = 0;
    status s = check_way(at);
    if (s != OK) return s;
    s = file_read(at->path, MAX_BYTES, &text, &size);
    if (s != OK && at->parent) s = fail_in(s, "%s: \"%s\"", at->parent->path, at->key);
    if (s == OK) s = json_parse(text, size, at->path, out);
    free(text);
    return s == OK ? check_once(*out, (*out)->root) : s;
}

/* Adds to `over` what only `base` has; objects that both have are merged. */
static void merge(cJSON *base, cJSON *over)
{
    cJSON *next;
    for (cJSON *item = base->child; item; item = next) {
        next = item->next;
        cJSON *own = cJSON_GetObjectItemCaseSensitive(over, item->string);
        if (!own)
            cJSON_AddItemToArray(
                over, cJSON_DetachItemViaPointer(base, item)); /* it keeps its name when it returns to the object */
        else if (cJSON_IsObject(own) && cJSON_IsObject(item))
            merge(item, own);
    }
}

static status load(const link *at, const char *part, json_object **out);

/* Reads the file whose path is in `item` of the file at `at`. */
static status load_named(const link *at, const cJSON *item, const char *part, json_object **out)
{
    const char *name = item->valuestring;
    char *folder = file_folder_of(at->path), *path = NULL;
    if (folder) path = *name == '/' ? strdup(name) : file_join(folder, name);
    status s = path ? OK : fail(MERLIN_NO_MEMORY, "%s: out of memory", at->path);
    if (s == OK) s = load(&(link){path, item->string, at}, part, out);
    free(path);
    free(folder);
    return s;
}

/* Replaces a path under `part` by that file's object. *named: there was one. */
static status put_part(const link *at, const json_object *o, const char *part, bool *named)
{
    const cJSON *item = part ? cJSON_GetObjectItemCaseSensitive(o->root, part) : NULL;
    *named = item && cJSON_IsString(item);
    if (!*named) return OK;
    json_object *found = NULL;
    status s = load_named(at, item, NULL, &found);
    if (s == OK && !cJSON_ReplaceItemInObjectCaseSensitive(o->root, part, found->root))
        s = fail(MERLIN_NO_MEMORY, "%s: out of memory", at->path);
    else if (s == OK)
        found->root = NULL;
    json_free(found);
    return s;
}

/* Merges the base file. own_part: the file names a part of its own and takes none from the base. */
static status put_base(const link *at, const json_object *o, const char *part, bool own_part)
{
    cJSON *item = cJSON_DetachItemFromObjectCaseSensitive(o->root, "base");
    if (!item) return OK;
    json_object *base = NULL;
    status s = cJSON_IsString(item) ? load_named(at, item, part, &base)
                                    : fail(MERLIN_BAD_INPUT, "%s: \"base\" must be the path of a file", at->path);
    if (s == OK && own_part) cJSON_DeleteItemFromObjectCaseSensitive(base->root, part);
    if (s == OK) merge(base->root, o->root);
    json_free(base);
    cJSON_Delete(item);
    return s;
}

static status load(const link *at, const char *part, json_object **out)
{
    bool own_part = false;
    *out = NULL;
    status s = open_file(at, out);
    bool based = s == OK && json_has(*out, "base");
    if (s == OK) s = put_part(at, *out, part, &own_part);
    if (s == OK) s = put_base(at, *out, part, own_part);
    if (s == OK && (based || own_part)) snprintf((*out)->where, JSON_WHERE, "%s with the files it names", at->path);
    if (s == OK) return OK;
    json_free(*out);
    *out = NULL;
    return s;
}

status json_file_read(const char *path, const char *part, json_object **out)
{
    return load(&(link){.path = path}, part, out);
}
