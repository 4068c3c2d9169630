/* SPDX-License-Identifier: MIT */
#include "image/exr/exr_context.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>

static _Thread_local char complaint[256];

static void keep_complaint(exr_const_context_t context, exr_result_t code, const char *message)
{
    (void)context;
    (void)code;
    if (complaint[0]) return;
    snprintf(complaint, sizeof complaint, "%s", message);
    complaint[strcspn(complaint, "\r\n")] = 0;
}

void exr_forget_complaint(void)
{
    complaint[0] = 0;
    errno = 0; /* tells lack of memory from what the library takes it for */
}

bool exr_complained_of(const char *words)
{
    return strstr(complaint, words) != NULL;
}

exr_context_initializer_t exr_quiet(void)
{
    exr_forget_complaint();
    exr_context_initializer_t init = EXR_DEFAULT_CONTEXT_INITIALIZER;
    init.error_handler_fn = keep_complaint;
    init.flags = EXR_CONTEXT_FLAG_DISABLE_CHUNK_RECONSTRUCTION;
    return init;
}

status exr_fail(status s, const char *verb, const char *path, exr_result_t code)
{
    if (code == EXR_ERR_OUT_OF_MEMORY || status_by_errno(s) == MERLIN_NO_MEMORY)
        return fail(MERLIN_NO_MEMORY, "no memory to %s %s", verb, path);
    return fail(s, "cannot %s %s: %s", verb, path, complaint[0] ? complaint : exr_get_default_error_message(code));
}
