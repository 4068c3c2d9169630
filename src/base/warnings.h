/* SPDX-License-Identifier: MIT */
/* Warnings tell the user what may be wrong with a result: each has a code for programs, in snake_case, and one sentence
 * for people. They are collected during the work and printed once, at its end:
 *
 *     warnings doubts = {0};
 *     if (burnt_out >= 0.1) warnings_add(&doubts, "burnt_out", "%.0f %% of the object is burnt out", 100 * burnt_out);
 *     ...
 *     json_put_item(report, "warnings", warnings_json(&doubts));      [{"code": ..., "message": ...}, ...]
 *     if (!quiet) warnings_print(&doubts, "estimate", photo, 3);              one line on standard error
 *
 * Nothing is allocated, so that no warning is lost when memory runs out, and lists can be copied. */
#ifndef MERLIN_BASE_WARNINGS_H
#define MERLIN_BASE_WARNINGS_H

#include <cjson/cJSON.h>
#include <stddef.h>

#include "merlin/warnings.h"

enum { WARNINGS_MOST = MERLIN_MOST_WARNINGS, WARNING_WORDS = MERLIN_WARNING_WORDS };

/* The library's own warnings, by short names for the inside. */
typedef merlin_warning warning;
typedef merlin_warnings warnings;

/* Appends a warning, whose code is a string literal; the message is kept to one line, without a full stop. The most
 * important ones come first. */
void warnings_add(warnings *list, const char *code, const char *format, ...) __attribute__((format(printf, 3, 4)));
/* Appends all of another list. */
void warnings_append(warnings *list, const warnings *more);
/* Returns the first warning of this code, or NULL. */
const warning *warnings_find(const warnings *list, const char *code);
/* Returns an array of objects with code and message; NULL if memory ran out. */
cJSON *warnings_json(const warnings *list);
/* Prints "PROGRAM COMMAND: SUBJECT: message; message" on one line to standard error, the first `most` warnings and how
 * many more there are; nothing if the list is empty. */
void warnings_print(const warnings *list, const char *command, const char *subject, size_t most);

#endif
