/* SPDX-License-Identifier: MIT */
/* A file and the one that it may name, base.json, from arbitrary bytes with a line of three dashes between: whatever is
 * accepted must have no key twice, and its base put in. */
#include <string.h>

#include "base/status.h"
#include "base/text/json_file.h"
#include "fuzz_file.h"

static const char between[] = "\n---\n";
static char first_path[64];

static void begin(void)
{
    if (!mkdtemp(fuzz_folder_path)) abort();
    snprintf(first_path, sizeof first_path, "%s/first.json", fuzz_folder_path);
    snprintf(fuzz_folder_link, sizeof fuzz_folder_link, "%s/base.json", fuzz_folder_path);
    if (symlink(fuzz_file((const uint8_t *)"", 0), fuzz_folder_link) != 0) abort();
}

static void finish(void)
{
    unlink(first_path);
    fuzz_folder_remove();
}

static void write_first(const uint8_t *data, size_t size)
{
    FILE *f = fopen(first_path, "wb");
    if (!f || fwrite(data, 1, size, f) != size || fclose(f) != 0) abort();
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    if (!first_path[0]) {
        begin();
        atexit(finish);
    }
    const uint8_t *cut = size ? memmem(data, size, between, strlen(between)) : NULL;
    size_t first = cut ? (size_t)(cut - data) : size;
    size_t rest = cut ? first + strlen(between) : size;
    write_first(data, first);
    (void)fuzz_file(data + rest, size - rest);
    json_object *o;
    if (json_file_read(first_path, "model", &o) != OK) return 0;
    char *inner = NULL;
    if (json_has(o, "base")) abort();
    if (json_inner(o, "model", &inner) != OK && strstr(status_message(), "twice")) abort();
    free(inner);
    json_free(o);
    return 0;
}
