/* SPDX-License-Identifier: MIT */
#include "base/status.h"

#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "base/messages.h"

/* static analysis replaces it by a macro (status.h) */
#undef fail
#undef fail_in
#undef fail_by_errno
#undef fail_shown

enum { MESSAGE_SIZE = 1024 };

static _Thread_local char message[MESSAGE_SIZE];

status fail(status s, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    vsnprintf(message, sizeof message, format, args);
    va_end(args);
    messages_one_line(message);
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
    /* a message that is too long loses its end */
    int room = MESSAGE_SIZE - 3 - used;
    if (used >= 0 && room > 0) snprintf(message + used, (size_t)(MESSAGE_SIZE - used), ": %.*s", room, inner);
    messages_one_line(message);
    return s;
}

status fail_shown(status s, const char *hidden, const char *shown)
{
    char inner[MESSAGE_SIZE];
    memcpy(inner, message, sizeof inner);
    char *at = strstr(inner, hidden);
    if (!at) return s;
    *at = 0;
    return fail(s, "%s%s%s", inner, shown, at + strlen(hidden));
}

status status_by_errno(status s)
{
    return errno == ENOMEM ? MERLIN_NO_MEMORY : s;
}

status fail_by_errno(status s, const char *format, ...)
{
    const int why = errno;
    char words[MESSAGE_SIZE];
    va_list args;
    va_start(args, format);
    vsnprintf(words, sizeof words, format, args);
    va_end(args);
    return fail(why == ENOMEM ? MERLIN_NO_MEMORY : s, "%s: %s", words, strerror(why));
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
