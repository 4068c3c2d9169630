/* A data set: samples (seed, first), (seed, first + 1), ... rendered into a folder, one thread a sample.
 *
 *     render_options o = render_options_default();
 *     o.folder = "data";
 *     o.count = 100;
 *     render_stats stats;
 *     status s = render_samples(&o, &stats);
 *
 * A sample depends on the options and (seed, index) alone, never on the number of threads. Samples already in the
 * folder are kept, so an interrupted run is continued by repeating it; render.txt in the folder says what made them,
 * options and what the files hold that they name (contents.h), and a run with others is refused rather than mixed in.
 */
#ifndef MERLIN_LAB_RENDER_GENERATE_H
#define MERLIN_LAB_RENDER_GENERATE_H

#include <stdbool.h>
#include <stddef.h>

#include "base/skipped.h"
#include "lab/render/render.h"

typedef struct render_options {
    const char *folder; /* NULL: render and throw away, to measure */
    uint64_t seed, first;
    size_t count;
    image_settings image; /* its fov is the narrowest, its slant is not looked at */
    float widest_fov;     /* degrees; lenses are drawn from image.fov to this, evenly in the logarithm; or 0 */
    float off_axis; /* pictures are cut out up to so many degrees beside the lens's axis, as far as a lens of 80 sees */
    bool environment;               /* an environment image and its SH coefficients as well */
    const char *environment_folder; /* maps from files instead of procedural ones; or NULL */
    const char *material_folder;    /* photographed materials on most objects; or NULL */
    const char *mesh_folder;        /* meshes instead of procedural objects for a share of them; or NULL */
    float mesh_share;               /* of the objects; 0 counts as one half */
    const char *mesh;               /* a mesh file instead of procedural objects; or NULL */
    bool quiet;                     /* no progress bar */
    int (*interrupted)(void);       /* polled between samples; may be NULL */
} render_options;

typedef struct render_stats {
    size_t rendered, kept; /* kept: were there already */
    uint64_t rays;
    double seconds;
    skipped_files skipped_maps, skipped_materials, skipped_meshes; /* of their folders; for render_stats_free */
} render_stats;
void render_stats_free(render_stats *stats);

/* 128 pixels, 60 degrees, 4 × 4 strata, 8 paths, environment on; no folder, count 0. */
render_options render_options_default(void);

/* Stops at the first failure, or with ERROR_STOPPED when interrupted; finished samples stay. stats is filled either
 * way. */
/* After a failure, too, *stats is for render_stats_free. */
status render_samples(const render_options *options, render_stats *stats);

/* One sample of such a set, in memory. */
status render_sample(const render_options *options, uint64_t index, sample *out);

/* The same in the environment of sample number `place`, which is given as well; options must ask for environments. */
status render_sample_elsewhere(const render_options *options, uint64_t index, uint64_t place, sample *out,
                               environment *env);

#endif
