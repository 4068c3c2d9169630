#include "cli/relight_output.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "estimate/api.h"
#include "image/animation.h"
#include "image/figure.h"
#include "image/resize.h"
#include "image/write.h"

enum { MOST_TILES = 24, TILE_SIZE = 192, COLUMNS = 6, LABEL_SIZE = 48, USUAL_FRAME = 512, ORBIT_MILLISECONDS = 3000 };
/* Viewers show frames of 10 ms and less, which a GIF counts by, for a tenth of a second. */
enum { LEAST_MILLISECONDS = 20 };
static const real ORBIT_TILT = (real)0.87; /* 50 degrees from the optical axis */

static bool stopped(const relight_job *job)
{
    return job->stop && job->stop();
}

/* Pictures of equal size and their labels, few enough for a sheet. */
typedef struct sheet {
    img pictures[MOST_TILES];
    char labels[MOST_TILES][LABEL_SIZE];
    int count;
} sheet;

static void sheet_free(sheet *s)
{
    for (int i = 0; i < s->count; i++)
        img_free(&s->pictures[i]);
}

/* In hundredths, and never as "-0.00". */
static double shown(float x)
{
    return round(100 * (double)x) / 100 + 0.0;
}

/* light NULL: the environment alone. */
static void label_light(const vec3 *light, char *label)
{
    if (light)
        snprintf(label, LABEL_SIZE, "%.2f, %.2f, %.2f", shown(light->x), shown(light->y), shown(light->z));
    else
        snprintf(label, LABEL_SIZE, "environment");
}

static status sheet_write(const sheet *s, const staging *t, const char *name)
{
    figure_tile tiles[MOST_TILES];
    for (int i = 0; i < s->count; i++)
        tiles[i] = (figure_tile){s->labels[i], &s->pictures[i]};
    char path[PATH_MAX];
    int columns = s->count < COLUMNS ? s->count : COLUMNS;
    return figure_sheet(staging_path(t, name, path), tiles, s->count, columns, TILE_SIZE);
}

/* A small copy of the square for the sheet, if there is room. */
static status sheet_add(sheet *s, const img *picture, const char *label)
{
    if (s->count == MOST_TILES) return OK;
    status result = img_resize(picture, TILE_SIZE, TILE_SIZE, &s->pictures[s->count]);
    if (result == OK) snprintf(s->labels[s->count++], LABEL_SIZE, "%s", label);
    return result;
}

static status relight(const relight_job *job, const stage *st, const vec3 *light, img *out)
{
    status s = stage_relight(job->model->network, st, light, out);
    progress_update(job->progress, job->progress->done + 1, NULL);
    return s;
}

static status write_picture(const staging *t, const char *pattern, size_t i, const img *picture)
{
    char name[32], path[PATH_MAX];
    snprintf(name, sizeof name, "%s_%03zu.png", pattern, i);
    return img_write_png(staging_path(t, name, path), picture, IMG_SRGB8);
}

/* ---- single lights, in the photograph's frame ---- */

typedef struct picture {
    const char *name;
    size_t number;
    const vec3 *light; /* NULL: the environment alone */
} picture;

/* all: where a small copy goes, or NULL. */
static status write_light(const relight_job *job, const stage *st, const staging *t, const picture *p, sheet *all)
{
    img square = {0}, whole = {0};
    status s = relight(job, st, p->light, &square);
    char label[LABEL_SIZE];
    label_light(p->light, label);
    if (s == OK && all) s = sheet_add(all, &square, label);
    if (s == OK) s = img_new(&whole, job->maps->mask.width, job->maps->mask.height, 3);
    if (s == OK) {
        crop_put(&square, crop_of(job->maps), &st->full.mask, &whole);
        s = write_picture(t, p->name, p->number, &whole);
    }
    img_free(&square);
    img_free(&whole);
    return s;
}

static status write_lights(const relight_job *job, stage *st, const staging *t)
{
    size_t count = job->lights.count;
    if (count == 0 && !job->environment) return OK;
    sheet all = {.count = 0};
    status s = job->environment ? stage_surround(st, &job->environment->map) : OK;
    if (s == OK && count == 0) s = write_light(job, st, t, &(picture){"relit", 0, NULL}, &all);
    for (size_t i = 0; i < count && s == OK; i++)
        s = stopped(job) ? fail(ERROR_STOPPED, "stopped")
                         : write_light(job, st, t, &(picture){"relit", i, &job->lights.at[i]}, &all);
    if (s == OK) s = sheet_write(&all, t, "relit.png");
    sheet_free(&all);
    return s;
}

/* ---- a dome: the frontal hemisphere, evenly ---- */

/* A Fibonacci spiral: equal steps of cosθ, the golden angle in φ. */
static vec3 dome_light(int i, int count)
{
    real cosine = 1 - ((real)i + (real)0.5) / (real)count, sine = sqrt(1 - cosine * cosine);
    real phi = (real)2.39996322972865332 * (real)i;
    return vec3_make(sine * cos(phi), sine * sin(phi), cosine - 1);
}

/* The directions to distant lights, which is what an .lp file knows. */
static void print_lp(FILE *f, const void *context)
{
    const relight_job *job = context;
    fprintf(f, "%d\n", job->dome);
    for (int i = 0; i < job->dome; i++) {
        vec3 l = vec3_add(dome_light(i, job->dome), vec3_make(0, 0, 1));
        fprintf(f, "dome_%03d.png %.6f %.6f %.6f\n", i, (double)l.x, (double)l.y, (double)l.z);
    }
}

static status write_lp(const relight_job *job, const staging *t)
{
    char path[PATH_MAX];
    return file_print(staging_path(t, "dome.lp", path), print_lp, job);
}

/* An earlier dome's list, whose lights these pictures of the same names would be believed to have. */
static bool has_list(const char *folder)
{
    char *path = file_join(folder, "dome.lp");
    light_list list = {0};
    bool has = path && file_exists(path) && light_list_read(path, &list) == OK && list.name &&
               strcmp(list.name[0], "dome_000.png") == 0;
    light_list_free(&list);
    free(path);
    return has;
}

static status write_dome_mask(const relight_job *job, const staging *t)
{
    char path[PATH_MAX];
    img mask = img_of(&job->maps->mask);
    return img_write_png(staging_path(t, "mask.png", path), &mask, IMG_LINEAR8);
}

static status write_dome(const relight_job *job, const stage *st, const staging *t)
{
    if (job->dome == 0) return OK;
    status s = OK;
    for (int i = 0; i < job->dome && s == OK; i++) {
        vec3 light = dome_light(i, job->dome);
        s = stopped(job) ? fail(ERROR_STOPPED, "stopped")
                         : write_light(job, st, t, &(picture){"dome", (size_t)i, &light}, NULL);
    }
    if (s == OK) s = write_dome_mask(job, t);
    bool listed = job->lp || has_list(job->output);
    return s == OK && listed ? write_lp(job, t) : s;
}

/* ---- an orbit, in the square ---- */

static vec3 orbit_light(int i, int count)
{
    real phi = (real)6.28318530717958647692 * (real)i / (real)count, sine = sin(ORBIT_TILT);
    return vec3_make(sine * cos(phi), sine * sin(phi), cos(ORBIT_TILT) - 1);
}

static status write_animations(const relight_job *job, const staging *t, const img_animation *frames)
{
    static const char *const names[] = {"orbit.webp", "orbit.gif"};
    int delay = ORBIT_MILLISECONDS / job->orbit;
    if (delay < LEAST_MILLISECONDS) delay = LEAST_MILLISECONDS;
    status s = OK;
    for (int i = 0; i < 2 && s == OK; i++) {
        if (stopped(job)) return fail(ERROR_STOPPED, "stopped");
        char path[PATH_MAX];
        s = img_animation_write(frames, staging_path(t, names[i], path), delay);
    }
    return s;
}

/* Under an environment, turned a step further for each frame, the light stays where it is. */
static status render_frame(const relight_job *job, stage *st, env_map *environment, int i, sheet *some, img *frame)
{
    vec3 moving = orbit_light(i, job->orbit);
    const vec3 *light = &moving;
    char label[LABEL_SIZE];
    label_light(light, label);
    if (job->environment) {
        light = job->lights.count ? &job->lights.at[0] : NULL;
        if (i > 0) env_map_turn(environment, 360.0f / (float)job->orbit);
        snprintf(label, sizeof label, "turned by %.0f°", 360.0 * i / job->orbit);
    }
    int step = (job->orbit + MOST_TILES - 1) / MOST_TILES;
    status s = job->environment ? stage_surround(st, environment) : OK;
    if (s == OK) s = relight(job, st, light, frame);
    return s == OK && i % step == 0 ? sheet_add(some, frame, label) : s;
}

static status write_frames(const relight_job *job, stage *st, const staging *t, img_animation *frames)
{
    sheet some = {.count = 0};
    /* shares the levels, which a turn does not change */
    env_map turning = job->environment ? job->environment->map : (env_map){.cosine = 1};
    status s = OK;
    for (int i = 0; i < job->orbit && s == OK; i++) {
        img frame = {0};
        if (stopped(job)) s = fail(ERROR_STOPPED, "stopped");
        if (s == OK) s = render_frame(job, st, &turning, i, &some, &frame);
        if (s == OK) s = write_picture(t, "frame", (size_t)i, &frame);
        if (s == OK) s = img_animation_add(frames, &frame);
        img_free(&frame);
    }
    if (s == OK) s = sheet_write(&some, t, "orbit.png");
    sheet_free(&some);
    return s;
}

static int frame_side(const relight_job *job)
{
    int crop = job->maps->crop.side;
    return job->frame ? job->frame : crop < USUAL_FRAME ? crop : USUAL_FRAME;
}

static status write_orbit(const relight_job *job, stage *st, const staging *t)
{
    if (job->orbit == 0) return OK;
    int side = frame_side(job);
    img_animation frames;
    status s = img_animation_new(side, side, job->orbit, &frames);
    if (s == OK) s = write_frames(job, st, t, &frames);
    if (s == OK) s = write_animations(job, t, &frames);
    img_animation_free(&frames);
    return s;
}

/* ---- all of them ---- */

static size_t count_whole(const relight_job *job)
{
    size_t lights = job->lights.count > 0 ? job->lights.count : job->environment != NULL;
    return lights + (size_t)job->dome;
}

size_t relight_count(const relight_job *job)
{
    return count_whole(job) + (size_t)job->orbit;
}

/* What the stage has taken over. */
static void let_go(merlin_maps *m)
{
    merlin_image *spent[] = {&m->albedo, &m->normal, &m->roughness, &m->depth, &m->photo};
    for (size_t i = 0; i < sizeof spent / sizeof spent[0]; i++)
        merlin_image_free(spent[i]);
}

static status write_all(const relight_job *job, const staging *t)
{
    bool whole = count_whole(job) > 0, both = whole && job->orbit > 0;
    stage st;
    status s = stage_new(job->model->network, job->maps, whole ? 0 : frame_side(job), job->how, &st);
    if (s != OK) return s;
    if (!both) let_go(job->maps);
    s = write_lights(job, &st, t);
    if (s == OK) s = write_dome(job, &st, t);
    if (s == OK && both) s = stage_resize(&st, job->maps, frame_side(job));
    if (both) let_go(job->maps);
    if (s == OK) s = write_orbit(job, &st, t);
    stage_free(&st);
    return s;
}

status relight_output(const relight_job *job, staged_files *written)
{
    staging *t;
    status s = staging_begin(job->output, job->inputs, &t);
    if (s != OK) return s;
    s = write_all(job, t);
    if (s == OK && stopped(job)) s = fail(ERROR_STOPPED, "stopped");
    return s == OK ? staging_commit(t, written) : staging_abort(t, s);
}
