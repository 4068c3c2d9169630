/* SPDX-License-Identifier: MIT */
#include "base/warnings.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/messages.h"
#include "base/utf8.h"

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
    for (char *c = w->message; *c; c++) /* file names may contain control characters */
        if ((unsigned char)*c < ' ') *c = '?';
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
        cJSON *one = cJSON_CreateObject();
        char *message = utf8_valid(list->at[i].message);
        cJSON_AddStringToObject(one, "code", list->at[i].code);
        if (message) cJSON_AddStringToObject(one, "message", message);
        free(message);
        cJSON_AddItemToArray(all, one);
    }
    return all;
}

void warnings_print(const warnings *list, const char *command, const char *subject, size_t most)
{
    size_t shown = list->count < most ? list->count : most, more = list->count - shown + list->more;
    if (list->count == 0) return;
    fprintf(messages(), "%s %s: %s: ", messages_program(), command, subject);
    for (size_t i = 0; i < shown; i++)
        fprintf(messages(), "%s%s", i ? "; " : "", list->at[i].message);
    if (more) fprintf(messages(), "%sand %zu more, which --json names", shown ? "; " : "", more);
    fputc('\n', messages());
}
