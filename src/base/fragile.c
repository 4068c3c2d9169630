/* SPDX-License-Identifier: MIT */
#include "base/fragile.h"

#include <stdatomic.h>

#include "base/memory.h"

static _Thread_local volatile int here;
static atomic_int anywhere;

status fragile_begin(const char *what, size_t bytes)
{
    if (!memory_is_left(bytes)) return fail(MERLIN_NO_MEMORY, "no memory for %s", what);
    here++;
    atomic_fetch_add(&anywhere, 1);
    return OK;
}

void fragile_end(void)
{
    here--;
    atomic_fetch_sub(&anywhere, 1);
}

bool fragile_is_here(void)
{
    return here > 0;
}

bool fragile_is_anywhere(void)
{
    return atomic_load(&anywhere) > 0;
}
