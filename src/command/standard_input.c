/* SPDX-License-Identifier: MIT */
#include "command/standard_input.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

enum { MOST = 512 << 20 };

static char kept[32]; /* name of the stored input; empty: none */

static status keep_block(int to, const char *block, size_t size)
{
    while (size > 0) {
        ssize_t done = write(to, block, size);
        if (done < 0 && errno == EINTR) continue;
        if (done <= 0) return fail_by_errno(MERLIN_NO_MEMORY, "no memory to keep standard input");
        block += done;
        size -= (size_t)done;
    }
    return OK;
}

static status keep_all(int to)
{
    static char block[1 << 16];
    size_t size = 0;
    for (ssize_t got; (got = read(STDIN_FILENO, block, sizeof block)) != 0;) {
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) return fail_by_errno(MERLIN_BAD_INPUT, "cannot read standard input");
        size += (size_t)got;
        if (size > MOST) return fail(MERLIN_BAD_INPUT, "standard input goes on beyond %d MB: give a file", MOST >> 20);
        status s = keep_block(to, block, (size_t)got);
        if (s != OK) return s;
    }
    return size ? OK : fail(MERLIN_BAD_INPUT, "standard input is empty");
}

status standard_input_take(char **argument)
{
    if (strcmp(*argument, "-") != 0) return OK;
    if (kept[0]) return fail(MERLIN_WRONG_USE, "standard input can be one file");
    int to = memfd_create("standard-input", MFD_CLOEXEC);
    if (to < 0) return fail_by_errno(MERLIN_NO_MEMORY, "no memory to keep standard input");
    status s = keep_all(to);
    if (s != OK) {
        close(to);
        return s;
    }
    snprintf(kept, sizeof kept, "/proc/self/fd/%d", to);
    *argument = kept;
    return OK;
}

bool standard_input_is(const char *path)
{
    return kept[0] && strcmp(path, kept) == 0;
}

const char *standard_input_name(const char *path)
{
    return standard_input_is(path) ? "standard input" : path;
}

void standard_input_tell(const char *message, char *out, int size)
{
    const char *at = kept[0] ? strstr(message, kept) : NULL;
    if (at)
        snprintf(out, (size_t)size, "%.*sstandard input%s", (int)(at - message), message, at + strlen(kept));
    else
        snprintf(out, (size_t)size, "%s", message);
}
