/* SPDX-License-Identifier: MIT */
#include "base/text/report.h"

#include "base/json/json_put.h"
#include "merlin/status.h"

cJSON *report_begin(const warnings *doubts)
{
    cJSON *root = cJSON_CreateObject();
    json_put_text(root, "version", merlin_version());
    json_put_number(root, "schema", REPORT_SCHEMA);
    if (doubts) json_put_item(root, "warnings", warnings_json(doubts));
    return root;
}
