/* SPDX-License-Identifier: MIT */
#include "cli/relight/relight_work.h"

#include <math.h>
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

/* Least linear value that is not 0 in an 8-bit file. */
static const float LEAST_SEEN = 0.5f / 255 / 12.92f;
static const double LITTLE_LIT = 0.01;

/* Counts the object's white pixels, and those that are not black. */
static void note_light(relight_work *w, const merlin_image *square)
{
    const merlin_image *mask = merlin_relighter_mask(w->relighter);
    size_t burnt = 0, lit = 0, count = 0;
    for (size_t i = 0; i < (size_t)mask->width * (size_t)mask->height; i++) {
        const float *value = square->data + 3 * i;
        if (mask->data[i] < 0.5f) continue;
        burnt += value[0] >= 1 || value[1] >= 1 || value[2] >= 1;
        lit += value[0] >= LEAST_SEEN || value[1] >= LEAST_SEEN || value[2] >= LEAST_SEEN;
        count++;
    }
    double share = count ? (double)burnt / (double)count : 0;
    w->result->burnt_out = fmax(w->result->burnt_out, share);
    w->result->burnt += share >= RELIGHT_MUCH_BURNT_OUT;
    w->result->dark += (double)lit < LITTLE_LIT * (double)count;
    w->result->pictures++;
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
    if (s == OK) note_light(w, out);
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
