/* SPDX-License-Identifier: MIT */
#include "base/warnings.h"

#include <limits.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "base/json/json_put.h"
#include "base/messages.h"

void warnings_add(warnings *list, const char *code, const char *format, ...)
{
    if (list->count == WARNINGS_MOST) {
        list->more++;
        return;
    }
    warning *w = &list->at[list->count++];
    w->code = code;
    va_list args;
    va_start(args, format);
    vsnprintf(w->message, sizeof w->message, format, args);
    va_end(args);
    messages_one_line(w->message);
}

void warnings_append(warnings *list, const warnings *more)
{
    for (size_t i = 0; i < more->count; i++)
        warnings_add(list, more->at[i].code, "%s", more->at[i].message);
    list->more += more->more;
}

const warning *warnings_find(const warnings *list, const char *code)
{
    for (size_t i = 0; i < list->count; i++)
        if (strcmp(list->at[i].code, code) == 0) return &list->at[i];
    return NULL;
}

cJSON *warnings_json(const warnings *list)
{
    cJSON *all = cJSON_CreateArray();
    for (size_t i = 0; i < list->count; i++) {
        cJSON *one = json_append_object(all);
        json_put_text(one, "code", list->at[i].code);
        json_put_text(one, "message", list->at[i].message);
    }
    return all;
}

void warnings_print(const warnings *list, const char *command, const char *subject, size_t most)
{
    size_t shown = list->count < most ? list->count : most, more = list->count - shown + list->more;
    if (list->count == 0) return;
    char name[PATH_MAX];
    snprintf(name, sizeof name, "%s", subject);
    messages_one_line(name);
    fprintf(messages(), "%s %s: %s: ", messages_program(), command, name);
    for (size_t i = 0; i < shown; i++)
        fprintf(messages(), "%s%s", i ? "; " : "", list->at[i].message);
    if (more) fprintf(messages(), "%sand %zu more, which --json names", shown ? "; " : "", more);
    fputc('\n', messages());
}
