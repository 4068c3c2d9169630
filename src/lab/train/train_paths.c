/* SPDX-License-Identifier: MIT */
#include "lab/train/train_paths.h"

#include <stdlib.h>

#include "base/file.h"

/* Refuses to overwrite the weights that a run starts from. */
static status check_kept(const train_options *o, const train_paths *p)
{
    bool replaces = o->init && file_is_same(o->init, p->weights);
    for (const char *const *w = o->init_shared; w && *w; w++)
        replaces |= file_is_same(*w, p->weights);
    if (!replaces) return OK;
    return fail(MERLIN_WRONG_USE, "%s would be replaced by what is trained from it: name another folder", p->weights);
}

status train_paths_new(const train_options *o, train_paths *out)
{
    const char *folder = o->output;
    *out = (train_paths){file_join(folder, "checkpoint.safetensors"), file_join(folder, "curves.csv"),
                         file_join(folder, "validation.csv"),         file_join(folder, "curves.png"),
                         file_join(folder, "weights.safetensors"),    file_join(folder, "seconds.txt")};
    if (!out->checkpoint || !out->curves || !out->validation || !out->chart || !out->weights || !out->seconds)
        return fail(MERLIN_NO_MEMORY, "out of memory");
    bool exists = file_exists(out->checkpoint);
    if (exists && !o->resume)
        return fail(MERLIN_WRONG_USE, "%s holds a run already: add --resume to go on with it, or name another folder",
                    folder);
    if (!exists && o->resume) return fail(MERLIN_BAD_INPUT, "%s has no checkpoint to resume from", folder);
    status s = check_kept(o, out);
    if (s == OK && !exists && file_exists(out->weights))
        s = fail(MERLIN_WRONG_USE, "%s are a run's whose checkpoint is gone: name another folder, or move them away",
                 out->weights);
    return s;
}

void train_paths_free(train_paths *p)
{
    free(p->checkpoint);
    free(p->curves);
    free(p->validation);
    free(p->chart);
    free(p->weights);
    free(p->seconds);
    *p = (train_paths){0};
}
