/* SPDX-License-Identifier: MIT */
#include "cli/relight/relight_work.h"

#include <stdio.h>

status relight_check(const relight_work *w)
{
    return w->job->stop && w->job->stop() ? fail(MERLIN_STOPPED, "stopped") : OK;
}

size_t relight_count_lights(const relight_job *job)
{
    if (job->lamps.count > 0) return job->together ? 1 : job->lamps.count;
    return job->environment || job->found;
}

size_t relight_count_whole(const relight_job *job)
{
    return relight_count_lights(job) + (size_t)job->dome.count;
}

bool relight_surroundings_turn(const relight_job *job)
{
    return job->environment || job->found;
}

const merlin_lamp *relight_lamps(const relight_work *w, size_t i, int *count)
{
    const relight_job *job = w->job;
    *count = job->found ? w->found.count : job->together ? (int)job->lamps.count : job->lamps.count > 0;
    return job->found ? w->found.lamps : job->lamps.at + i;
}

status relight_square(relight_work *w, const merlin_lamp *lights, int count, merlin_image *out)
{
    const merlin_environment *around = w->job->found ? w->found.rest : w->job->environment;
    status s = merlin_relighter_render_lamps(w->relighter, lights, count, around, out);
    if (s == OK) relit_light_note(&w->result->seen, out, merlin_relighter_mask(w->relighter));
    return s;
}

const char *relight_ending(const relight_job *job)
{
    return job->format == MERLIN_JPEG ? ".jpg" : ".png";
}

static status write_named(const relight_work *w, const char *name, const merlin_image *whole)
{
    char file[64], path[PATH_MAX];
    snprintf(file, sizeof file, "%s%s", name, relight_ending(w->job));
    return merlin_image_write(staging_path(w->staging, file, path), whole);
}

status relight_write(relight_work *w, const relight_picture *p)
{
    merlin_image square = {0}, whole = {0};
    char name[32], label[RELIGHT_LABEL];
    snprintf(name, sizeof name, "%s_%03zu", p->name, p->number);
    relight_label(p->lights, p->count, label);
    watch_tell(w->job->watch, "relighting", (double)w->done++ / (double)relight_count_whole(w->job));
    status s = relight_square(w, p->lights, p->count, &square);
    if (s == OK && p->sheet) s = relight_sheet_add(p->sheet, &square, label);
    if (s == OK) s = merlin_relighter_place(w->relighter, &square, &whole);
    if (s == OK) s = write_named(w, name, &whole);
    if (s == OK && p->alone) s = write_named(w, p->name, &whole);
    merlin_image_free(&square);
    merlin_image_free(&whole);
    return s;
}
