/* SPDX-License-Identifier: MIT */
#include "base/text/report.h"

#include "merlin/status.h"

cJSON *report_begin(const warnings *doubts)
{
    cJSON *root = cJSON_CreateObject();
    cJSON_AddStringToObject(root, "version", merlin_version());
    cJSON_AddNumberToObject(root, "schema", REPORT_SCHEMA);
    if (doubts) cJSON_AddItemToObject(root, "warnings", warnings_json(doubts));
    return root;
}
