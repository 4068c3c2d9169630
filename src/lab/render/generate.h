/* SPDX-License-Identifier: MIT */
/* Generates a data set: samples (seed, first), (seed, first + 1), ... rendered into a folder, one thread a sample.
 *
 *     render_options o = render_options_default();
 *     o.folder = "data";
 *     o.count = 100;
 *     render_stats stats;
 *     status s = render_samples(&o, &stats);
 *
 * A sample depends on the options and (seed, index) alone, never on the number of threads. Samples already in the
 * folder are kept, so that an interrupted run is continued by repeating it; render.txt in the folder records the
 * options and checksums of the files they name (contents.h), and a run with others is refused. */
#ifndef MERLIN_LAB_RENDER_GENERATE_H
#define MERLIN_LAB_RENDER_GENERATE_H

#include <stddef.h>

#include "base/skipped.h"
#include "lab/render/render_options.h"

typedef struct render_stats {
    size_t rendered, kept; /* kept: existed already */
    uint64_t rays;
    double seconds;
    skipped_files skipped_maps, skipped_materials, skipped_meshes; /* freed by render_stats_free */
} render_stats;
void render_stats_free(render_stats *stats);

/* Returns the defaults: 128 pixels, 60 degrees, 4 × 4 strata, 8 paths, with environment; no folder, count 0. */
render_options render_options_default(void);

/* Renders the samples. Stops at the first failure, or with MERLIN_STOPPED when interrupted; finished samples stay.
 * *stats is filled in any case, also after a failure, and must be freed by render_stats_free. */
status render_samples(const render_options *options, render_stats *stats);

/* Renders one sample of such a set in memory. */
status render_sample(const render_options *options, uint64_t index, sample *out);

/* Renders one sample in the environment of sample number `place`, which is returned as well; the options must include
 * environments. */
status render_sample_elsewhere(const render_options *options, uint64_t index, uint64_t place, sample *out,
                               environment *env);

#endif
