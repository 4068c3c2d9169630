/* SPDX-License-Identifier: MIT */
#include "cli/relight/relight_output.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/relight/relight_parts.h"
#include "cli/relight/relight_rti.h"

enum { USUAL_FRAME = 512 };

/* ---- single lights, in the photograph's frame ---- */

/* Writes relit.png: a single light's picture, or a sheet of several lights' pictures. */
static status write_lights(relight_work *w)
{
    const relight_job *job = w->job;
    size_t count = relight_count_lights(job);
    relight_sheet all = {.count = 0};
    char path[PATH_MAX];
    status s = OK;
    for (size_t i = 0; i < count && s == OK; i++) {
        relight_picture p = {.name = "relit", .number = i, .sheet = count > 1 ? &all : NULL, .alone = count == 1};
        p.lights = relight_lamps(w, i, &p.count);
        s = relight_check(w);
        if (s == OK) s = relight_write(w, &p);
    }
    if (s == OK && count > 1) s = relight_sheet_write(&all, staging_path(w->staging, "relit.png", path));
    relight_sheet_free(&all);
    return s;
}

/* ---- the whole ---- */

static int frame_side(const relight_job *job)
{
    int crop = job->maps->crop.side;
    return job->frame ? job->frame : crop < USUAL_FRAME ? crop : USUAL_FRAME;
}

/* Frees what the relighter has copied. */
static void free_photo_maps(merlin_maps *m)
{
    merlin_image *spent[] = {&m->albedo, &m->normal, &m->roughness, &m->depth, &m->photo};
    for (size_t i = 0; i < sizeof spent / sizeof spent[0]; i++)
        merlin_image_free(spent[i]);
}

static status write_all(relight_work *w)
{
    const relight_job *job = w->job;
    bool whole = relight_count_whole(job) > 0, both = whole && job->orbit > 0;
    status s = relight_prepare(w, whole ? 0 : frame_side(job));
    if (s == OK && !both) free_photo_maps(job->maps);
    if (s == OK) s = write_lights(w);
    if (s == OK && job->dome.count) s = job->rti.wanted ? relight_write_rti(w) : relight_write_dome(w);
    if (s == OK && both) s = merlin_relighter_resize(w->relighter, job->maps, frame_side(job));
    if (both) free_photo_maps(job->maps);
    if (s == OK && job->orbit) s = relight_write_orbit(w, frame_side(job));
    merlin_relighter_free(w->relighter);
    merlin_found_lights_free(&w->found);
    return s;
}

status relight_output(const relight_job *job, relight_result *result)
{
    relight_work w = {.job = job, .result = result};
    *result = (relight_result){0};
    status s = job->dome.count && !job->rti.wanted ? relight_dome_check(job) : OK;
    if (s == OK) s = relight_check_replaced(job);
    if (s == OK) s = staging_begin(job->output, job->inputs, &w.staging);
    if (s != OK) return s;
    s = job->frames ? relight_write_frames(&w) : write_all(&w);
    if (s == OK) s = relight_check(&w);
    if (s != OK) return staging_abort(w.staging, s);
    s = staging_commit(w.staging, &result->files);
    if (s == OK) relight_find_left(job, result);
    return s;
}

/* ---- to standard output ---- */

static status print(const uint8_t *data, size_t size)
{
    bool done = fwrite(data, 1, size, stdout) == size && fflush(stdout) == 0;
    return done ? OK : fail_by_errno(MERLIN_CANNOT_WRITE, "cannot write to standard output");
}

status relight_print(const relight_job *job, relight_result *result)
{
    relight_work w = {.job = job, .result = result};
    *result = (relight_result){0};
    merlin_image square = {0}, whole = {0};
    uint8_t *data = NULL;
    size_t size = 0;
    status s = relight_prepare(&w, 0);
    watch_tell(job->watch, "relighting", 0);
    int count;
    const merlin_lamp *lights = relight_lamps(&w, 0, &count);
    if (s == OK) s = relight_square(&w, lights, count, &square);
    if (s == OK) s = merlin_relighter_place(w.relighter, &square, &whole);
    if (s == OK) s = merlin_image_encode(&whole, job->format, &data, &size);
    if (s == OK) s = relight_check(&w);
    if (s == OK) s = print(data, size);
    free(data);
    merlin_image_free(&square);
    merlin_image_free(&whole);
    merlin_relighter_free(w.relighter);
    merlin_found_lights_free(&w.found);
    return s;
}
