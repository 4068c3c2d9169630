/* SPDX-License-Identifier: MIT */
/* The object in other light: from maps of an earlier job, of a file, or of a photograph that is estimated first, to a
 * picture for each lamp, in a room, or in the estimated light. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/json/json_put.h"
#include "base/lights/relit_light.h"
#include "serve/jobs/photo_form.h"
#include "serve/jobs/work_kinds.h"

enum { MOST_LIGHTS = 64, LEAST_SIDE = 16, MOST_SIDE = 4096, FARTHEST = 1000 };

#define MAPS "maps.exr"

typedef struct relight_request {
    merlin_params params; /* parameters for a photograph */
    bool photo;
    merlin_lamp lamps[MOST_LIGHTS];
    int lamp_count;
    int together; /* 1: all lamps at once, else a picture each */
    float rotate, room_exposure;
    int found, side; /* side 0: the photograph's size */
    merlin_relighting how;
} relight_request;

/* ---- options ---- */

/* Reads the index-th value of light or direction: x, y, z, and perhaps a power for all channels or for each. */
static status read_lamp(const form *f, const char *key, size_t index, merlin_lamp *out)
{
    const char *text = form_value_at(f, key, index);
    int count = 1;
    float numbers[6] = {0};
    for (; text && *text; text++)
        count += *text == ',';
    if (count != 3 && count != 4 && count != 6)
        return fail(MERLIN_WRONG_USE, "%s wants 3 numbers x,y,z, and perhaps a power or three, not \"%s\"", key,
                    form_value_at(f, key, index));
    status s = form_numbers(f, key, index, -FARTHEST, FARTHEST, count, numbers);
    const bool far_away = strcmp(key, "direction") == 0;
    *out = far_away ? merlin_lamp_toward(numbers[0], numbers[1], numbers[2])
                    : merlin_lamp_at(numbers[0], numbers[1], numbers[2]);
    for (int c = 0; c < 3 && count > 3; c++)
        out->power[c] = numbers[count == 6 ? 3 + c : 3];
    if (s == OK && (out->power[0] < 0 || out->power[1] < 0 || out->power[2] < 0))
        s = fail(MERLIN_WRONG_USE, "%s: a power is 0 or more", key);
    if (s == OK && far_away && numbers[0] == 0 && numbers[1] == 0 && numbers[2] == 0)
        s = fail(MERLIN_WRONG_USE, "direction wants a length, not 0,0,0");
    return s;
}

/* Reads light, direction, or the number of lamps on an orbit or a dome. */
static status read_lamps(const form *f, relight_request *r)
{
    static const char *const keys[] = {"light", "direction"};
    int orbit = 0, dome = 0;
    status s = OK;
    for (size_t k = 0; k < sizeof keys / sizeof *keys; k++)
        for (size_t i = 0; form_value_at(f, keys[k], i) && s == OK; i++) {
            if (r->lamp_count == MOST_LIGHTS) return fail(MERLIN_WRONG_USE, "more than %d lamps", MOST_LIGHTS);
            s = read_lamp(f, keys[k], i, &r->lamps[r->lamp_count++]);
        }
    if (s == OK) s = form_integer(f, "orbit", 2, MOST_LIGHTS, &orbit);
    if (s == OK) s = form_integer(f, "dome", 2, MOST_LIGHTS, &dome);
    if (s == OK && (r->lamp_count > 0) + (orbit > 0) + (dome > 0) > 1)
        s = fail(MERLIN_WRONG_USE, "lamps, orbit and dome go one without the others");
    if (s != OK || (!orbit && !dome)) return s;
    r->lamp_count = orbit ? orbit : dome;
    for (int i = 0; i < r->lamp_count; i++)
        r->lamps[i] = orbit ? merlin_orbit_lamp(i, orbit) : merlin_dome_lamp(i, dome, 0);
    return OK;
}

static status check_source(const form *f, relight_request *r)
{
    const int sources =
        (form_value(f, "job") != NULL) + (form_find_file(f, "photo") != NULL) + (form_find_file(f, "maps") != NULL);
    if (sources != 1)
        return fail(MERLIN_WRONG_USE,
                    "relight wants one of photo, maps (a maps.exr) and job (an estimate that is done)");
    r->photo = form_find_file(f, "photo") != NULL;
    return r->photo ? photo_form_params(f, &r->params) : photo_form_refuse(f, "relight of maps");
}

/* Refuses fields without what they change. */
static status check_changes(const form *f, const relight_request *r)
{
    const bool room = form_find_file(f, "environment") != NULL;
    if (form_value(f, "environment_exposure") && !room)
        return fail(MERLIN_WRONG_USE, "environment_exposure wants an environment");
    if (form_value(f, "rotate") && !room && !r->found)
        return fail(MERLIN_WRONG_USE, "rotate wants an environment, or the light that was found, to turn");
    if (r->together && r->lamp_count == 0)
        return fail(MERLIN_WRONG_USE, "together is of the lamps of light, direction, orbit and dome");
    if (r->together && r->how == MERLIN_BY_NETWORK)
        return fail(MERLIN_WRONG_USE, "together goes not by network, whose decoder knows one lamp alone");
    return OK;
}

static status check_lights(const form *f, const relight_request *r)
{
    const bool room = form_find_file(f, "environment") != NULL;
    if (!room && !r->found && r->lamp_count == 0)
        return fail(MERLIN_WRONG_USE, "relight wants a light: light, direction, orbit, dome, environment or found");
    if (r->found && (room || r->lamp_count)) return fail(MERLIN_WRONG_USE, "found goes without lamps and environment");
    if (r->found && (r->side || r->how == MERLIN_BY_NETWORK))
        return fail(MERLIN_WRONG_USE, "found goes without side, and not by network");
    status s = OK;
    if (room && r->lamp_count == 0) s = merlin_relighting_check(r->how, NULL, 1);
    for (int i = 0; i < r->lamp_count && s == OK; i++)
        s = merlin_relighting_check(r->how, &r->lamps[i], room);
    return s;
}

/* Keeps the maps' name for the maps. */
static status check_names(const form *f)
{
    const form_file *room = form_find_file(f, "environment");
    if (!room || strcmp(room->name, MAPS) != 0) return OK;
    return fail(MERLIN_WRONG_USE, "an environment is not called %s, as maps are", MAPS);
}

static status check(const form *f, const work_limits *limits, void **request)
{
    static const form_key known[] = {PHOTO_KEYS,
                                     {"maps", FORM_FILE, 1},
                                     {"job", FORM_VALUE, 1},
                                     {"light", FORM_VALUE, MOST_LIGHTS},
                                     {"direction", FORM_VALUE, MOST_LIGHTS},
                                     {"orbit", FORM_VALUE, 1},
                                     {"dome", FORM_VALUE, 1},
                                     {"together", FORM_VALUE, 1},
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
    if (s == OK) s = read_lamps(f, r);
    if (s == OK) s = form_flag(f, "together", &r->together);
    if (s == OK) s = form_real(f, "rotate", -360, 360, &r->rotate);
    if (s == OK) s = form_real(f, "environment_exposure", -20, 20, &r->room_exposure);
    if (s == OK) s = form_flag(f, "found", &r->found);
    if (s == OK) s = form_integer(f, "side", LEAST_SIDE, MOST_SIDE, &r->side);
    if (s == OK) s = form_choice(f, "by", ways, sizeof ways / sizeof *ways, &way);
    if (s == OK) s = check_names(f);
    r->how = (merlin_relighting)way;
    if (s == OK) s = check_lights(f, r);
    return s == OK ? check_changes(f, r) : s;
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
    merlin_relighter *relighter; /* NULL: by the light that was found */
    relit_light *seen;
} relight_work;

/* The square under these lamps or, of no asked size, in the photograph's frame. */
static status make(const relight_work *k, const merlin_lamp *lamps, int count, merlin_image *out)
{
    const relight_request *r = k->request;
    merlin_image square = {0};
    if (r->found) {
        status s = merlin_relight_found(k->context->model, k->maps, r->rotate, r->how, out);
        if (s == OK) relit_light_note(k->seen, out, &k->maps->mask);
        return s;
    }
    status s = merlin_relighter_render_lamps(k->relighter, lamps, count, k->room, &square);
    if (s == OK) relit_light_note(k->seen, &square, merlin_relighter_mask(k->relighter));
    if (s == OK && r->side) {
        *out = square;
        return OK;
    }
    if (s == OK) s = merlin_relighter_place(k->relighter, &square, out);
    merlin_image_free(&square);
    return s;
}

static status make_all(const relight_work *k)
{
    const work_context *w = k->context;
    const relight_request *r = k->request;
    const bool each = r->lamp_count > 1 && !r->together;
    const int count = each ? r->lamp_count : 1;
    char name[32], path[PATH_MAX];
    status s = OK;
    for (int i = 0; i < count && s == OK; i++) {
        merlin_image picture = {0};
        w->progress(w->progress_context, "relighting", (float)i / (float)count);
        if (w->stop()) return fail(MERLIN_STOPPED, "stopped");
        snprintf(name, sizeof name, count > 1 ? "relit_%03d.png" : "relit.png", i);
        s = make(k, r->lamps + i, each ? 1 : r->lamp_count, &picture);
        if (s == OK) s = merlin_image_write(store_path(w->store, w->form->id, STORE_OUT, name, path), &picture);
        merlin_image_free(&picture);
    }
    return s;
}

/* Prepares for a captured surface, which has no gloss, and no exposure of a photograph: white is that of lamps of power
 * 1, so that a stronger one is brighter. */
static status prepare_captured(const relight_work *k)
{
    const relight_request *r = k->request;
    const size_t count = (size_t)r->lamp_count;
    float white = 1;
    if (r->how == MERLIN_BY_NETWORK) return fail(MERLIN_BAD_INPUT, "a captured surface is not relit by network");
    status s = merlin_relighter_make_matte(k->relighter);
    if (s != OK || count == 0) return s;
    merlin_lamp *usual = malloc(count * sizeof *usual);
    if (!usual) return fail(MERLIN_NO_MEMORY, "no memory for %zu lamps", count);
    memcpy(usual, r->lamps, count * sizeof *usual);
    for (size_t i = 0; i < count; i++)
        usual[i].power[0] = usual[i].power[1] = usual[i].power[2] = 1;
    s = r->together ? merlin_relighter_meter_together(k->relighter, usual, count, k->room, &white)
                    : merlin_relighter_meter(k->relighter, usual, count, k->room, &white);
    free(usual);
    return s == OK ? merlin_relighter_set_white(k->relighter, white) : s;
}

/* Reports as the command does. */
static void report(const relight_work *k)
{
    const relight_request *r = k->request;
    cJSON *to = k->context->report;
    const merlin_model *model = k->context->model;
    warnings doubts;
    merlin_maps_warnings(k->maps, &doubts);
    if (r->lamp_count || r->found) merlin_relighting_warnings(model, k->maps, r->how, &doubts);
    relit_light_warn_negative(merlin_environment_negative(k->room), &doubts);
    relit_light_warn(k->seen, k->room ? "environment_exposure, or lamps of less power" : "lamps of less power",
                     &doubts);
    json_put_item(to, "warnings", warnings_json(&doubts));
    json_put_text(to, "by", r->how == MERLIN_BY_NETWORK ? "network" : "brdf");
    json_put_text(to, "model", merlin_relighting_model(model, k->maps, r->how));
    json_put_number(to, "burnt_out", round(1e4 * k->seen->burnt_out) / 1e4);
}

static status relight(const work_context *w, const relight_request *r, const merlin_maps *maps)
{
    const form_file *room = form_find_file(w->form, "environment");
    relit_light seen = {.pictures = 0};
    relight_work k = {.context = w, .request = r, .maps = maps, .seen = &seen};
    merlin_environment *environment = NULL;
    char path[PATH_MAX];
    status s = OK;
    if (room)
        s = merlin_environment_read(store_path(w->store, w->form->id, STORE_IN, room->name, path), r->rotate,
                                    r->room_exposure, &environment);
    k.room = environment;
    if (s == OK && !r->found) s = merlin_relighter_new(w->model, maps, r->side, r->how, &k.relighter);
    if (s == OK && k.relighter && maps->captured) s = prepare_captured(&k);
    if (s == OK) s = make_all(&k);
    if (s == OK) report(&k);
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
    s = relight(w, r, &maps);
    merlin_maps_free(&maps);
    return s;
}

static const work_stage stages[] = {{"reading", 0.1f},  {"finding the object", 0.1f}, {"estimating", 0.2f},
                                    {"refining", 0.1f}, {"relighting", 0.5f},         {0}};
const work_kind work_relight = {.name = "relight", .stages = stages, .check = check, .run = run, .uses = MAPS};
