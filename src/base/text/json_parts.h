/* SPDX-License-Identifier: MIT */
/* Layout of a json_object, for the functions that create one. */
#ifndef MERLIN_BASE_TEXT_JSON_PARTS_H
#define MERLIN_BASE_TEXT_JSON_PARTS_H

#include <cjson/cJSON.h>

enum { JSON_KEYS = 64, JSON_WHERE = 256 };

struct json_object {
    cJSON *root;
    char where[JSON_WHERE];
    const cJSON *asked[JSON_KEYS];
    int asked_count;
};

#endif
