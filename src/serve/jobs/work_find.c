/* SPDX-License-Identifier: MIT */
#include "serve/jobs/work_find.h"

#include <string.h>

#include "serve/jobs/work_kinds.h"

const work_kind *work_find(const char *name)
{
    static const work_kind *const kinds[] = {&work_mask, &work_estimate, &work_relight, &work_stereo};
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++)
        if (strcmp(kinds[i]->name, name) == 0) return kinds[i];
    return NULL;
}
