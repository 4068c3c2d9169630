/* SPDX-License-Identifier: MIT */
#include "lab/eval/samples/each_sample.h"

#include "base/file.h"
#include "base/progress.h"
#include "lab/render/sample.h"

status eval_each_sample(const eval_samples *of, status (*each)(void *context, const char *path), void *context)
{
    char **names;
    size_t count;
    status s = sample_list(of->folder, &names, &count);
    if (s != OK) return s;
    const size_t used = of->count && of->count < count ? of->count : count;
    progress p;
    progress_begin(&p, of->what, "samples", 0, used, of->quiet);
    for (size_t i = 0; s == OK && i < used; i++) {
        s = of->stopped && of->stopped() ? fail(MERLIN_STOPPED, "stopped after %zu of %zu samples", i, used)
                                         : each(context, names[i]);
        if (s == OK) progress_update(&p, i + 1, NULL);
    }
    progress_end(&p);
    file_list_free(names, count);
    return s;
}
