/* SPDX-License-Identifier: MIT */
#include "base/status.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

/* the analysis' view of them, where it is in force */
#undef fail
#undef fail_in

enum { MESSAGE_SIZE = 1024 };

static _Thread_local char message[MESSAGE_SIZE];

/* A message is one line, whatever names a damaged file brought into it. */
static void keep_one_line(void)
{
    for (char *c = message; *c; c++)
        if ((unsigned char)*c < ' ') *c = '?';
}

status fail(status s, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    vsnprintf(message, sizeof message, format, args);
    va_end(args);
    keep_one_line();
    return s;
}

status fail_in(status s, const char *format, ...)
{
    char inner[MESSAGE_SIZE];
    memcpy(inner, message, sizeof inner);
    va_list args;
    va_start(args, format);
    int used = vsnprintf(message, sizeof message, format, args);
    va_end(args);
    /* a message too long for the place loses its end */
    int room = MESSAGE_SIZE - 3 - used;
    if (used >= 0 && room > 0) snprintf(message + used, (size_t)(MESSAGE_SIZE - used), ": %.*s", room, inner);
    keep_one_line();
    return s;
}

const char *status_message(void)
{
    return message;
}

const char *merlin_error(void)
{
    return status_message();
}

const char *merlin_version(void)
{
    return MERLIN_VERSION;
}
