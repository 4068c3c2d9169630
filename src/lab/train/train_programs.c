/* SPDX-License-Identifier: MIT */
#include "lab/train/train_programs.h"

#include "base/rng.h"
#include "lab/train/config/streams.h"

static status add(const nn_graph *g, nn_params *params, const nn_options *options, const train_source *source,
                  train_programs *out)
{
    train_program *p = &out->at[out->count++];
    status s = nn_compile(g, params, options, &p->program);
    return s == OK ? train_loader_new(p->program, source, &p->loader) : s;
}

status train_programs_new(const nn_graph *g, nn_params *params, const nn_options *options, const train_source *source,
                          int most, train_programs *out)
{
    *out = (train_programs){.count = 0};
    nn_options its = *options;
    train_source from = *source;
    status s = OK;
    const int fewest = source->config->fewest_pictures > 1 ? (int)source->config->fewest_pictures : 1;
    for (int pictures = fewest; s == OK && pictures <= most && out->count < TRAIN_PROGRAMS; pictures++) {
        if (options->batch % pictures || (pictures > 1 && options->batch / pictures < 2)) continue;
        its.group = from.pictures = pictures;
        its.beside = out->count ? out->at[0].program : NULL; /* the first has most objects, and most maps */
        s = add(g, params, &its, &from, out);
    }
    if (s == OK && out->count == 0)
        s = fail(MERLIN_BAD_INPUT, "no number of pictures from %d to %d divides a batch of %d into two objects or more",
                 fewest, most, options->batch);
    if (s != OK) train_programs_free(out);
    return s;
}

void train_programs_free(train_programs *programs)
{
    for (int i = programs->count; i-- > 0;) {
        train_loader_free(programs->at[i].loader);
        nn_program_free(programs->at[i].program);
    }
    *programs = (train_programs){.count = 0};
}

const train_program *train_programs_at(const train_programs *programs, uint64_t seed, uint64_t step)
{
    rng r = rng_at(seed, step, TRAIN_STREAM_PICTURES);
    return &programs->at[programs->count > 1 ? rng_below(&r, programs->count) : 0];
}
