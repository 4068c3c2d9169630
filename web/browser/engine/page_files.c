/* SPDX-License-Identifier: MIT */
/* Files are handed to the page as soon as they are written, by their names: base/file.h without a disk. */
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "page_calls.h"

status file_write(const char *path, const void *data, size_t size)
{
    page_file(path, data, size);
    return OK;
}

status file_print(const char *path, file_printer *print, const void *context)
{
    char *data = NULL;
    size_t size = 0;
    FILE *f = open_memstream(&data, &size);
    if (!f) return fail(MERLIN_NO_MEMORY, "no memory to write %s", path);
    print(f, context);
    status s = fclose(f) == 0 ? file_write(path, data, size) : fail(MERLIN_NO_MEMORY, "no memory to write %s", path);
    free(data);
    return s;
}
