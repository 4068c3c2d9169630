/* SPDX-License-Identifier: MIT */
/* The relighter of a job, and the exposure of its pictures. */
#include <math.h>
#include <stdlib.h>

#include "cli/relight/relight_parts.h"

static size_t count_lamps(const relight_job *job)
{
    return job->lamps.count + (size_t)job->dome.count + (relight_surroundings_turn(job) ? 0 : (size_t)job->orbit);
}

/* Collects all lamps of all pictures, which get one exposure so that they can be compared. */
static void gather(const relight_job *job, merlin_lamp *all)
{
    size_t count = 0;
    for (size_t i = 0; i < job->lamps.count; i++)
        all[count++] = job->lamps.at[i];
    for (int i = 0; i < job->dome.count; i++)
        all[count++] = relight_dome_lamp(job, i);
    for (int i = 0; !relight_surroundings_turn(job) && i < job->orbit; i++)
        all[count++] = relight_orbit_lamp(job, i);
    for (size_t i = 0; job->exposing == RELIGHT_BY_LAMPS && i < count; i++)
        all[i].power[0] = all[i].power[1] = all[i].power[2] = 1;
}

/* Meters lamps for one picture each, or for one picture of all together. */
static status meter(const relight_work *w, const merlin_lamp *all, size_t count, float *white)
{
    const relight_job *job = w->job;
    return job->together ? merlin_relighter_meter_together(w->relighter, all, count, job->environment, white)
                         : merlin_relighter_meter(w->relighter, all, count, job->environment, white);
}

static status expose(relight_work *w)
{
    const relight_job *job = w->job;
    const float as_source = merlin_relighter_white(w->relighter);
    float white = as_source;
    size_t count = count_lamps(job);
    bool metered = job->exposing == RELIGHT_AUTO || (job->exposing == RELIGHT_BY_LAMPS && count > 0);
    merlin_lamp *all = malloc((count + 1) * sizeof *all);
    if (!all) return fail(MERLIN_NO_MEMORY, "no memory for %zu lamps", count);
    gather(job, all);
    status s = metered ? meter(w, all, count, &white) : OK;
    white /= exp2f(job->ev);
    if (s == OK) s = merlin_relighter_set_white(w->relighter, white);
    w->result->ev = log2f(as_source / white);
    free(all);
    return s;
}

status relight_prepare(relight_work *w, int side)
{
    const relight_job *job = w->job;
    watch_tell(job->watch, "preparing", 0);
    status s = merlin_relighter_new(job->model, job->maps, side, job->how, &w->relighter);
    if (s == OK && job->matte) s = merlin_relighter_make_matte(w->relighter);
    if (s == OK && job->found) s = merlin_found_lights_new(&job->maps->light, job->turn, &w->found);
    return s == OK ? expose(w) : s;
}
