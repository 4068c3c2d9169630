/* SPDX-License-Identifier: MIT */
#include "command/check_files.h"

#include "base/file.h"
#include "base/staging.h"

status check_named(const char *what, const char *path)
{
    if (!path || file_exists(path)) return OK;
    return fail(MERLIN_BAD_INPUT, "there is no %s %s", what, path);
}

status check_photo_and_mask(const char *photo, const char *mask)
{
    status s = check_named("photograph", photo);
    return s == OK ? check_named("mask", mask) : s;
}

status check_output(const char *folder)
{
    staging *t;
    status s = staging_begin(folder, NULL, &t);
    return s == OK ? staging_abort(t, OK) : s;
}
