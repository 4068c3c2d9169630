/* SPDX-License-Identifier: MIT */
/* An orbit: frames of the square, and animations of them. */
#include <stdio.h>

#include "cli/relight/relight_parts.h"
#include "merlin/merlin.h"

enum { ORBIT_MILLISECONDS = 3000 };
/* Shortest frame, as viewers show frames of 10 ms, a GIF's unit, and less for a tenth of a second. */
enum { LEAST_MILLISECONDS = 20 };

merlin_lamp relight_orbit_lamp(const relight_job *job, int i)
{
    return lamp_in_style(merlin_orbit_lamp(i, job->orbit), &job->lamps.common);
}

static status write_animations(const relight_work *w, const merlin_animation *frames)
{
    static const char *const names[] = {"orbit.webp", "orbit.gif"};
    int delay = ORBIT_MILLISECONDS / w->job->orbit;
    if (delay < LEAST_MILLISECONDS) delay = LEAST_MILLISECONDS;
    status s = OK;
    for (int i = 0; i < 2 && s == OK; i++) {
        char path[PATH_MAX];
        watch_tell(w->job->watch, "animating", (double)i / 2);
        s = relight_check(w);
        if (s == OK) s = merlin_animation_write(frames, staging_path(w->staging, names[i], path), delay);
    }
    return s;
}

/* Renders frame i. An environment rotates by a further step in each, while the user's lamps stay. */
static status render_frame(relight_work *w, int i, relight_sheet *some, merlin_image *frame)
{
    const relight_job *job = w->job;
    const merlin_lamp moving = relight_orbit_lamp(job, i), *lights = &moving;
    const float further = 360.0f / (float)job->orbit;
    int count = 1, step = (job->orbit + RELIGHT_MOST_TILES - 1) / RELIGHT_MOST_TILES;
    char label[RELIGHT_LABEL];
    relight_label(lights, 1, label);
    if (relight_surroundings_turn(job)) snprintf(label, sizeof label, "turned by %.0f°", 360.0 * i / job->orbit);
    if (relight_surroundings_turn(job)) lights = relight_lamps(w, 0, &count);
    if (job->found && i > 0) merlin_found_lights_turn(&w->found, further);
    if (job->environment && i > 0) merlin_environment_turn(job->environment, further);
    status s = relight_square(w, lights, count, frame);
    return s == OK && i % step == 0 ? relight_sheet_add(some, frame, label) : s;
}

static status write_frame(const relight_work *w, int i, const merlin_image *frame)
{
    char name[32], path[PATH_MAX];
    snprintf(name, sizeof name, "frame_%03d.png", i);
    return merlin_image_write(staging_path(w->staging, name, path), frame);
}

static status write_frames(relight_work *w, merlin_animation *frames)
{
    const relight_job *job = w->job;
    relight_sheet some = {.count = 0};
    char path[PATH_MAX];
    status s = OK;
    for (int i = 0; i < job->orbit && s == OK; i++) {
        merlin_image frame = {0};
        watch_tell(job->watch, "going round", (double)i / job->orbit);
        s = relight_check(w);
        if (s == OK) s = render_frame(w, i, &some, &frame);
        if (s == OK) s = write_frame(w, i, &frame);
        if (s == OK) s = merlin_animation_add(frames, &frame);
        merlin_image_free(&frame);
    }
    if (s == OK) s = relight_sheet_write(&some, staging_path(w->staging, "orbit.png", path));
    relight_sheet_free(&some);
    return s;
}

status relight_write_orbit(relight_work *w, int side)
{
    merlin_animation *frames;
    status s = merlin_animation_new(side, side, w->job->orbit, &frames);
    if (s == OK) s = write_frames(w, frames);
    if (s == OK) s = write_animations(w, frames);
    merlin_animation_free(frames);
    return s;
}
