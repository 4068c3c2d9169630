/* SPDX-License-Identifier: MIT */
/* The object in other light: from maps of an earlier job, of a file, or of a photograph that is estimated first, to a
 * picture for each lamp, in a room, or in the estimated light. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/json/json_put.h"
#include "serve/jobs/photo_form.h"
#include "serve/jobs/work_kinds.h"

enum { MOST_LIGHTS = 64, LEAST_SIDE = 16, MOST_SIDE = 4096, FARTHEST = 1000 };

#define MAPS "maps.exr"

typedef struct relight_request {
    merlin_params params; /* of a photograph */
    bool photo;
    float lights[MOST_LIGHTS][3];
    int light_count;
    float rotate, room_exposure;
    int found, side; /* side 0: the photograph's size */
    merlin_relighting how;
} relight_request;

/* ---- options ---- */

static status read_lights(const form *f, relight_request *r)
{
    status s = OK;
    for (int i = 0; i < MOST_LIGHTS && form_value_at(f, "light", (size_t)i) && s == OK; i++) {
        s = form_numbers(f, "light", (size_t)i, -FARTHEST, FARTHEST, 3, r->lights[i]);
        r->light_count = i + 1;
    }
    return s;
}

static status check_source(const form *f, relight_request *r)
{
    const int sources =
        (form_value(f, "job") != NULL) + (form_find_file(f, "photo") != NULL) + (form_find_file(f, "maps") != NULL);
    if (sources != 1)
        return fail(MERLIN_WRONG_USE,
                    "relight wants one of photo, maps (a maps.exr) and job (an estimate that is done)");
    r->photo = form_find_file(f, "photo") != NULL;
    return r->photo ? photo_form_params(f, &r->params) : OK;
}

static status check_lights(const form *f, const relight_request *r)
{
    const bool room = form_find_file(f, "environment") != NULL;
    if (!room && !r->found && r->light_count == 0)
        return fail(MERLIN_WRONG_USE, "relight wants a light: light, environment or found");
    if (r->found && (room || r->light_count)) return fail(MERLIN_WRONG_USE, "found goes without light and environment");
    if (r->found && (r->side || r->how == MERLIN_BY_NETWORK))
        return fail(MERLIN_WRONG_USE, "found goes without side, and not by network");
    if (room && r->light_count > 1) return fail(MERLIN_WRONG_USE, "with an environment there is one light at most");
    return OK;
}

static status check(const form *f, const work_limits *limits, void **request)
{
    static const form_key known[] = {PHOTO_KEYS,
                                     {"maps", FORM_FILE, 1},
                                     {"job", FORM_VALUE, 1},
                                     {"light", FORM_VALUE, MOST_LIGHTS},
                                     {"environment", FORM_FILE, 1},
                                     {"rotate", FORM_VALUE, 1},
                                     {"environment_exposure", FORM_VALUE, 1},
                                     {"found", FORM_VALUE, 1},
                                     {"by", FORM_VALUE, 1},
                                     {"side", FORM_VALUE, 1},
                                     {0}};
    static const char *const ways[] = {"brdf", "network", "unshadowed", "direct"};
    int way = MERLIN_BY_BRDF;
    relight_request *r = calloc(1, sizeof *r);
    (void)limits;
    *request = r;
    if (!r) return fail(MERLIN_NO_MEMORY, "no memory for a request");
    status s = form_check(f, "relight", known);
    if (s == OK) s = check_source(f, r);
    if (s == OK) s = read_lights(f, r);
    if (s == OK) s = form_real(f, "rotate", -360, 360, &r->rotate);
    if (s == OK) s = form_real(f, "environment_exposure", -20, 20, &r->room_exposure);
    if (s == OK) s = form_flag(f, "found", &r->found);
    if (s == OK) s = form_integer(f, "side", LEAST_SIDE, MOST_SIDE, &r->side);
    if (s == OK) s = form_choice(f, "by", ways, sizeof ways / sizeof *ways, &way);
    r->how = (merlin_relighting)way;
    return s == OK ? check_lights(f, r) : s;
}

/* ---- the maps ---- */

/* Renames an uploaded file, which has its client's name, to the reader's. */
static status name_maps(const work_context *w)
{
    const form_file *sent = form_find_file(w->form, "maps");
    char from[PATH_MAX], to[PATH_MAX];
    if (!sent || strcmp(sent->name, MAPS) == 0) return OK;
    store_path(w->store, w->form->id, STORE_IN, sent->name, from);
    store_path(w->store, w->form->id, STORE_IN, MAPS, to);
    return rename(from, to) == 0 ? OK : fail_by_errno(MERLIN_CANNOT_WRITE, "the server cannot keep uploads");
}

static status read_maps(const work_context *w, merlin_maps *maps)
{
    char folder[PATH_MAX];
    w->progress(w->progress_context, "reading", 0);
    status s = name_maps(w);
    if (s == OK) s = merlin_maps_read(store_path(w->store, w->form->id, STORE_IN, NULL, folder), maps);
    if (s != OK) return s;
    const double millions = 1e-6 * maps->mask.width * maps->mask.height;
    if (millions <= w->limits->megapixels) return OK;
    merlin_maps_free(maps);
    return fail(MERLIN_BAD_INPUT, "the maps have %.1f million pixels, and this server takes %g at most", millions,
                w->limits->megapixels);
}

/* ---- the pictures ---- */

typedef struct relight_work {
    const work_context *context;
    const relight_request *request;
    const merlin_maps *maps;
    const merlin_environment *room;
    merlin_relighter *relighter; /* of the square, if a size is given; else NULL */
} relight_work;

static status make(const relight_work *k, const float *light, merlin_image *out)
{
    const relight_request *r = k->request;
    merlin_model *model = k->context->model;
    if (r->found) return merlin_relight_found(model, k->maps, r->rotate, r->how, out);
    if (k->relighter) return merlin_relighter_render(k->relighter, light, k->room, out);
    if (k->room) return merlin_relight_environment(model, k->maps, k->room, light, r->how, out);
    return merlin_relight(model, k->maps, light, r->how, out);
}

static status make_all(const relight_work *k)
{
    const work_context *w = k->context;
    const relight_request *r = k->request;
    const int count = r->light_count > 1 ? r->light_count : 1;
    char name[32], path[PATH_MAX];
    status s = OK;
    for (int i = 0; i < count && s == OK; i++) {
        merlin_image picture = {0};
        w->progress(w->progress_context, "relighting", (float)i / (float)count);
        if (w->stop()) return fail(MERLIN_STOPPED, "stopped");
        snprintf(name, sizeof name, count > 1 ? "relit_%03d.png" : "relit.png", i);
        s = make(k, r->light_count ? r->lights[i] : NULL, &picture);
        if (s == OK) s = merlin_image_write(store_path(w->store, w->form->id, STORE_OUT, name, path), &picture);
        merlin_image_free(&picture);
    }
    return s;
}

static status relight(const work_context *w, const relight_request *r, const merlin_maps *maps)
{
    const form_file *room = form_find_file(w->form, "environment");
    relight_work k = {.context = w, .request = r, .maps = maps};
    merlin_environment *environment = NULL;
    char path[PATH_MAX];
    status s = OK;
    if (room)
        s = merlin_environment_read(store_path(w->store, w->form->id, STORE_IN, room->name, path), r->rotate,
                                    r->room_exposure, &environment);
    k.room = environment;
    if (s == OK && r->side) s = merlin_relighter_new(w->model, maps, r->side, r->how, &k.relighter);
    if (s == OK) s = make_all(&k);
    merlin_relighter_free(k.relighter);
    merlin_environment_free(environment);
    return s;
}

static status run(const work_context *w, const void *request)
{
    const relight_request *r = request;
    merlin_maps maps;
    status s = r->photo ? photo_form_estimate(w, &r->params, &maps) : read_maps(w, &maps);
    if (s != OK) return s;
    json_put_text(w->report, "model", maps.model);
    s = relight(w, r, &maps);
    merlin_maps_free(&maps);
    return s;
}

static const work_stage stages[] = {{"reading", 0.1f},  {"finding the object", 0.1f}, {"estimating", 0.2f},
                                    {"refining", 0.1f}, {"relighting", 0.5f},         {0}};
const work_kind work_relight = {.name = "relight", .stages = stages, .check = check, .run = run, .uses = MAPS};
