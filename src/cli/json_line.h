/* What commands print with --json: one line of valid JSON, whatever bytes a file's name has.
 *
 *     cJSON *report = cJSON_CreateObject();
 *     json_line_text(report, "photo", path);
 *     json_line_print(report);
 */
#ifndef MERLIN_CLI_JSON_LINE_H
#define MERLIN_CLI_JSON_LINE_H

#include <cJSON.h>

/* Adds a text, U+FFFD in the place of each byte that is not UTF-8. */
void json_line_text(cJSON *object, const char *key, const char *text);
void json_line_print(const cJSON *report);

#endif
