/* SPDX-License-Identifier: MIT */
/* An orbit: frames of the square, and animations of them. */
#include <math.h>
#include <stdio.h>

#include "cli/relight/relight_parts.h"
#include "image/write/animation.h"

enum { ORBIT_MILLISECONDS = 3000 };
/* Viewers show frames of 10 ms and less, which a GIF counts by, for a tenth of a second. */
enum { LEAST_MILLISECONDS = 20 };
static const real ORBIT_TILT = (real)0.87; /* 50 degrees from the optical axis */

lamp relight_orbit_lamp(const relight_job *job, int i)
{
    real phi = (real)6.28318530717958647692 * (real)i / (real)job->orbit, sine = sin(ORBIT_TILT);
    lamp l = lamp_at(vec3_make(sine * cos(phi), sine * sin(phi), cos(ORBIT_TILT) - 1));
    l.tint = lamp_tint(&job->lamps.common);
    return l;
}

static status write_animations(const relight_work *w, const img_animation *frames)
{
    static const char *const names[] = {"orbit.webp", "orbit.gif"};
    int delay = ORBIT_MILLISECONDS / w->job->orbit;
    if (delay < LEAST_MILLISECONDS) delay = LEAST_MILLISECONDS;
    status s = OK;
    for (int i = 0; i < 2 && s == OK; i++) {
        char path[PATH_MAX];
        watch_tell(w->job->watch, "animating", (double)i / 2);
        s = relight_check(w);
        if (s == OK) s = img_animation_write(frames, staging_path(w->staging, names[i], path), delay);
    }
    return s;
}

/* Renders frame i. Surroundings turn a step further for each, and the user's lamps stay where they are then. */
static status render_frame(relight_work *w, env_map *environment, int i, relight_sheet *some, img *frame)
{
    const relight_job *job = w->job;
    const lamp moving = relight_orbit_lamp(job, i), *lights = &moving;
    const float further = 360.0f / (float)job->orbit;
    int count = 1, step = (job->orbit + RELIGHT_MOST_TILES - 1) / RELIGHT_MOST_TILES;
    char label[RELIGHT_LABEL];
    status s = OK;
    relight_label(lights, 1, label);
    if (relight_surroundings_turn(job)) snprintf(label, sizeof label, "turned by %.0f°", 360.0 * i / job->orbit);
    if (relight_surroundings_turn(job)) lights = relight_lamps(w, 0, &count);
    if (job->found && i > 0) found_lights_turn(&w->found, further);
    if (job->environment && i > 0) env_map_turn(environment, further);
    if (job->environment) s = relighter_surround(&w->relighter, environment);
    if (s == OK) s = relight_square(w, lights, count, frame);
    return s == OK && i % step == 0 ? relight_sheet_add(some, frame, label) : s;
}

static status write_frame(const relight_work *w, int i, const img *frame)
{
    char name[32], path[PATH_MAX];
    snprintf(name, sizeof name, "frame_%03d.png", i);
    return img_write_png(staging_path(w->staging, name, path), frame, IMG_SRGB8);
}

static status write_frames(relight_work *w, img_animation *frames)
{
    const relight_job *job = w->job;
    relight_sheet some = {.count = 0};
    char path[PATH_MAX];
    /* shares the levels, which a turn does not change */
    env_map turning = job->environment ? job->environment->map : (env_map){.cosine = 1};
    status s = OK;
    for (int i = 0; i < job->orbit && s == OK; i++) {
        img frame = {0};
        watch_tell(job->watch, "going round", (double)i / job->orbit);
        s = relight_check(w);
        if (s == OK) s = render_frame(w, &turning, i, &some, &frame);
        if (s == OK) s = write_frame(w, i, &frame);
        if (s == OK) s = img_animation_add(frames, &frame);
        img_free(&frame);
    }
    if (s == OK) s = relight_sheet_write(&some, staging_path(w->staging, "orbit.png", path));
    relight_sheet_free(&some);
    return s;
}

status relight_write_orbit(relight_work *w, int side)
{
    img_animation frames;
    status s = img_animation_new(side, side, w->job->orbit, &frames);
    if (s == OK) s = write_frames(w, &frames);
    if (s == OK) s = write_animations(w, &frames);
    img_animation_free(&frames);
    return s;
}
