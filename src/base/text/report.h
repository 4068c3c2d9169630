/* SPDX-License-Identifier: MIT */
/* Begins every report of a command, on standard output and in report.json. docs/json.md lists all names. */
#ifndef MERLIN_BASE_TEXT_REPORT_H
#define MERLIN_BASE_TEXT_REPORT_H

#include "base/json/json_put.h"
#include "base/warnings.h"

/* Version of the reports' format: it changes when a name is removed or changes its meaning, not when one is added. */
enum { REPORT_SCHEMA = 1 };

/* Begins a report with "version", "schema" and "warnings"; without the latter if doubts is NULL, so that the caller
 * adds them later. NULL if memory ran out. */
cJSON *report_begin(const warnings *doubts);

#endif
