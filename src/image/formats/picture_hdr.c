/* SPDX-License-Identifier: MIT */
/* Parts of a Radiance header that libvips ignores: colours in CIE XYZ, and rows in another order than from the top
 * left. */
#include <stdio.h>
#include <string.h>

#include "base/file.h"
#include "image/formats/picture.h"

enum { LINE_SIZE = 2048 };

/* Reads the next line without its end; returns false behind the last. */
static bool next_line(FILE *f, char line[LINE_SIZE])
{
    if (!fgets(line, LINE_SIZE, f)) return false;
    line[strcspn(line, "\r\n")] = 0;
    return true;
}

/* Checks the header; a damaged one is left to libvips, which reports it. */
static status check_open(FILE *f, const char *path)
{
    char line[LINE_SIZE], first, second;
    bool xyz = false;
    while (next_line(f, line) && line[0])
        xyz |= strcmp(line, "FORMAT=32-bit_rle_xyze") == 0;
    if (xyz)
        return fail(MERLIN_BAD_INPUT, "cannot read %s: its colours are CIE XYZ; make it RGB first (ra_xyze -r -o)",
                    path);
    if (!next_line(f, line) || sscanf(line, "%*1[-+]%c %*d %*1[-+]%c", &first, &second) != 2) return OK;
    if (line[0] == '-' && first == 'Y' && strstr(line, "+X")) return OK;
    return fail(MERLIN_BAD_INPUT, "cannot read %s: its rows run another way (%.40s) than -Y and +X; turn it first",
                path, line);
}

status picture_check_hdr(const char *path)
{
    FILE *f = file_open(path);
    if (!f) return fail_by_errno(MERLIN_BAD_INPUT, "cannot read %s", path);
    status s = check_open(f, path);
    fclose(f);
    return s;
}
