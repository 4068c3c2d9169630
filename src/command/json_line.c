/* SPDX-License-Identifier: MIT */
#include "command/json_line.h"

#include <stdio.h>
#include <stdlib.h>

#include "base/utf8.h"

static cJSON *string_of(const char *text)
{
    char *valid = utf8_valid(text);
    cJSON *string = valid ? cJSON_CreateString(valid) : NULL;
    free(valid);
    return string;
}

void json_line_text(cJSON *object, const char *key, const char *text)
{
    cJSON_AddItemToObject(object, key, string_of(text));
}

void json_line_files(cJSON *object, const char *folder, const staged_files *written)
{
    json_line_text(object, "output", folder);
    cJSON *list = cJSON_AddArrayToObject(object, "files");
    for (size_t i = 0; i < written->count; i++)
        cJSON_AddItemToArray(list, string_of(written->at[i]));
    cJSON_AddNumberToObject(object, "bytes", (double)written->bytes);
}

status json_report_print(char *text)
{
    if (!text) return fail(MERLIN_NO_MEMORY, "no memory for the report");
    puts(text);
    fflush(stdout); /* whoever reads a batch's lines has each when its work is done */
    free(text);
    return OK;
}

status json_line_print(const cJSON *report)
{
    return json_report_print(cJSON_PrintUnformatted(report));
}
