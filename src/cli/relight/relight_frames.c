/* SPDX-License-Identifier: MIT */
/* A sequence under a new light: a picture of each frame, and a video of them. */
#include <math.h>
#include <stdio.h>

#include "cli/relight/relight_parts.h"
#include "merlin/merlin.h"

/* Frames a second where the sequence does not say. */
static const double USUAL_RATE = 25;

typedef struct frames_work {
    relight_work *work;
    merlin_video *video; /* NULL: none is written */
    float white;         /* of all frames */
} frames_work;

/* Begins the video; without an encoder it is left out. */
static status begin_video(frames_work *f, const merlin_image *frame)
{
    relight_work *w = f->work;
    char path[PATH_MAX];
    const double rate = w->job->frames->rate;
    status s = merlin_video_create(staging_path(w->staging, "relit.mp4", path), frame->width, frame->height,
                                   rate > 0 ? rate : USUAL_RATE, &f->video);
    if (s != MERLIN_DEVICE_FAILED) return s;
    snprintf(w->result->no_video, sizeof w->result->no_video, "%s", merlin_error());
    return OK;
}

/* Renders frame i: an orbit goes once round in as many frames as it has. */
static status render(const frames_work *f, size_t i, merlin_image *square)
{
    relight_work *w = f->work;
    const relight_job *job = w->job;
    const int step = job->orbit ? (int)(i % (size_t)job->orbit) : 0;
    const float further = job->orbit ? 360.0f / (float)job->orbit : 0;
    const merlin_lamp moving = job->orbit ? relight_orbit_lamp(job, step) : (merlin_lamp){.distant = 0};
    int count = 1;
    const merlin_lamp *lights = &moving;
    if (!job->orbit || relight_surroundings_turn(job)) lights = relight_lamps(w, 0, &count);
    if (job->found) merlin_found_lights_turn(&w->found, further * (float)step);
    if (job->environment && i > 0) merlin_environment_turn(job->environment, further);
    return relight_square(w, lights, count, square);
}

static status write_picture(const frames_work *f, size_t i, const merlin_image *whole)
{
    const relight_work *w = f->work;
    char name[64], file[80], path[PATH_MAX];
    merlin_sequence_folder(w->job->frames->at[i].number, name, sizeof name);
    snprintf(file, sizeof file, "%s%s", name, relight_ending(w->job));
    status s = merlin_image_write(staging_path(w->staging, file, path), whole);
    return s == OK && f->video ? merlin_video_add(f->video, whole) : s;
}

/* Makes the relighter of frame i, exposed as its own photograph, or as the first frame was metered. */
static status prepare(frames_work *f, size_t i)
{
    relight_work *w = f->work;
    const relight_job *job = w->job;
    if (i > 0) merlin_maps_free(job->maps);
    status s = i > 0 ? merlin_maps_read(job->frames->at[i].folder, job->maps) : OK;
    if (s == OK && job->found && !job->maps->light.known)
        s = fail(MERLIN_BAD_INPUT, "%s does not have the light of its photograph", job->frames->at[i].folder);
    if (i == 0) {
        s = relight_prepare(w, 0);
        f->white = s == OK ? merlin_relighter_white(w->relighter) : 0;
        return s;
    }
    if (s == OK) s = merlin_relighter_new(job->model, job->maps, 0, job->how, &w->relighter);
    if (s == OK && job->matte) s = merlin_relighter_make_matte(w->relighter);
    if (s == OK && job->found) s = merlin_found_lights_new(&job->maps->light, job->turn, &w->found);
    const bool as_source = job->exposing == RELIGHT_AS_SOURCE;
    if (s == OK && as_source) f->white = merlin_relighter_white(w->relighter) / exp2f(job->ev);
    return s == OK ? merlin_relighter_set_white(w->relighter, f->white) : s;
}

static status write_frame(frames_work *f, size_t i)
{
    relight_work *w = f->work;
    merlin_image square = {0}, whole = {0};
    status s = prepare(f, i);
    if (s == OK) s = render(f, i, &square);
    if (s == OK) s = merlin_relighter_place(w->relighter, &square, &whole);
    if (s == OK && i == 0) s = begin_video(f, &whole);
    if (s == OK) s = write_picture(f, i, &whole);
    merlin_image_free(&square);
    merlin_image_free(&whole);
    merlin_relighter_free(w->relighter);
    merlin_found_lights_free(&w->found);
    w->relighter = NULL;
    return s;
}

status relight_write_frames(relight_work *w)
{
    frames_work f = {.work = w};
    const size_t count = w->job->frames->count;
    status s = OK;
    for (size_t i = 0; i < count && s == OK; i++) {
        s = relight_check(w);
        if (s == OK) s = write_frame(&f, i);
        watch_tell(w->job->watch, "relighting", (double)(i + 1) / (double)count);
    }
    if (!f.video) return s;
    if (s == OK) return merlin_video_finish(f.video, 1);
    (void)merlin_video_finish(f.video, 0); /* keeps the message of the failure */
    return s;
}
