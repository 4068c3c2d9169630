/* SPDX-License-Identifier: MIT */
#include "image/plain/plain_file.h"

status plain_damaged(const plain_file *f)
{
    return fail(MERLIN_BAD_INPUT, "cannot read %s: it is damaged or cut short", f->path);
}

status plain_check(const plain_file *f, double least_bytes)
{
    status s = picture_check_size(f->path, f->layout.width, f->layout.height);
    return s == OK && (double)f->size < least_bytes ? plain_damaged(f) : s;
}
