/* SPDX-License-Identifier: MIT */
#include "view/view_name.h"

#include "base/file.h"

status view_check_name(const char *path)
{
    static const char *const endings[] = {".html", ".htm", NULL};
    if (file_ends_in_any(file_name_of(path), endings)) return OK;
    return fail(MERLIN_WRONG_USE, "%s: the page's name ends in .html or .htm", path);
}
