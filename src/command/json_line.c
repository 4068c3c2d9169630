/* SPDX-License-Identifier: MIT */
#include "command/json_line.h"

#include <stdio.h>
#include <stdlib.h>

#include "base/json/json_put.h"

void json_line_files(cJSON *object, const char *folder, const staged_files *written)
{
    json_put_text(object, "output", folder);
    cJSON *list = json_put_array(object, "files");
    for (size_t i = 0; i < written->count; i++)
        json_append_text(list, written->at[i]);
    json_put_number(object, "bytes", (double)written->bytes);
}

void json_line_warnings(cJSON *report, const warnings *doubts)
{
    cJSON *list = warnings_json(doubts);
    if (!cJSON_ReplaceItemInObject(report, "warnings", list)) cJSON_Delete(list);
}

status json_report_print(char *text)
{
    if (!text) return fail(MERLIN_NO_MEMORY, "no memory for the report");
    puts(text);
    fflush(stdout); /* so that readers of a batch get each line when its work is done */
    free(text);
    return OK;
}

status json_line_print(const cJSON *report)
{
    return json_report_print(json_print_line(report));
}
