/* SPDX-License-Identifier: MIT */
#include "lab/cli/eval/judge.h"

#include <stdlib.h>
#include <string.h>

#include "command/photos.h"

status judge_check(const char *method)
{
    if (!method || strcmp(method, "universal") == 0) return OK;
    return fail(MERLIN_WRONG_USE, "--method adds \"universal\", not \"%s\"", method);
}

status judge_find(const char *method, judge *out, stereo_options *options)
{
    *out = (judge){NULL, NULL};
    if (!method) return OK;
    char *flash = NULL;
    status s = photo_find_models("merlin-any", &out->weights, &flash);
    free(flash);
    if (s == OK) s = photo_find_several(NULL, &out->several);
    options->judge = out->weights;
    options->several = out->several;
    return s;
}

void judge_free(judge *j)
{
    free(j->weights);
    free(j->several);
    *j = (judge){NULL, NULL};
}
