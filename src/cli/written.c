/* SPDX-License-Identifier: MIT */
#include "cli/written.h"

#include <stdio.h>
#include <string.h>

#include "base/file.h"

bool written_has(const staged_files *written, const char *name)
{
    for (size_t i = 0; i < written->count; i++)
        if (strcmp(file_name_of(written->at[i]), file_name_of(name)) == 0) return true;
    return false;
}

const char *written_words(const staged_files *written, char words[WRITTEN_WORDS])
{
    static const char *const units[] = {"bytes", "kB", "MB", "GB"};
    enum { UNITS = sizeof units / sizeof units[0] };
    double size = (double)written->bytes;
    int unit = 0;
    while (unit + 1 < UNITS && size >= 999.5) {
        size /= 1000;
        unit++;
    }
    snprintf(words, WRITTEN_WORDS, "%zu file%s, %.*f %s", written->count, written->count == 1 ? "" : "s",
             unit > 0 && size < 9.95, size, units[unit]);
    return words;
}
