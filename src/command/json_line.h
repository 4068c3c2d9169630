/* SPDX-License-Identifier: MIT */
/* The output of --json: one line of valid JSON, whatever bytes a file's name has.
 *
 *     cJSON *report = report_begin(&doubts);
 *     json_put_text(report, "input", path);
 *     json_line_files(report, folder, &written);
 *     json_line_print(report);
 *
 * In every command "input" is its input, "output" the folder that it wrote, "files" the paths of all files that it
 * wrote, usable as they are, and "bytes" the sum of their sizes. */
#ifndef MERLIN_COMMAND_JSON_LINE_H
#define MERLIN_COMMAND_JSON_LINE_H

#include "base/staging.h"
#include "base/status.h"
#include "base/warnings.h"
#include <cjson/cJSON.h>

/* Prints a report's own text, which has several lines and is freed; NULL: memory ran out. */
status json_report_print(char *text);

/* Adds "output", "files" and "bytes". */
void json_line_files(cJSON *object, const char *folder, const staged_files *written);
/* Puts these in the place of the report's warnings. */
void json_line_warnings(cJSON *report, const warnings *doubts);
status json_line_print(const cJSON *report);

#endif
