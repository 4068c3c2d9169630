/* SPDX-License-Identifier: MIT */
/* Makes a surface of pictures of an object under many lights, or of one photograph. */
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "serve/jobs/maps_files.h"
#include "serve/jobs/mesh_files.h"
#include "serve/jobs/photo_form.h"
#include "serve/jobs/work_kinds.h"

/* Accepted endings. Names are checked when files are read: a list of another data set's layout, uploaded as a picture,
 * could contain paths. */
static const char *const picture_endings[] = {".png",  ".jpg", ".jpeg", ".tif", ".tiff", ".webp", ".heic", ".heif",
                                              ".avif", ".exr", ".hdr",  ".bmp", ".pgm",  ".ppm",  ".pfm",  ".cr2",
                                              ".cr3",  ".nef", ".arw",  ".dng", ".raf",  ".rw2",  ".orf",  NULL};

typedef struct stereo_request {
    bool photo;     /* whether it is one photograph, which is relit */
    bool universal; /* whether the lights are unknown, and the model sees the pictures together */
    merlin_params photo_params;
    merlin_stereo_params params;
    int near_lights, unknown_lights, linear;
    float field_of_view, distance;
} stereo_request;

/* ---- options ---- */

static status check_pictures(const form *f, const work_limits *limits, bool universal)
{
    const int least = universal ? 1 : 3;
    const char *wants = universal ? "stereo without lights wants" : "stereo wants";
    int count = 0;
    for (size_t i = 0; i < f->file_count; i++) {
        const form_file *file = &f->files[i];
        if (strcmp(file->key, "lights") == 0) continue;
        count += strcmp(file->key, "pictures") == 0;
        if (!file_ends_in_any(file->name, picture_endings))
            return fail(MERLIN_WRONG_USE, "%s, sent as %s, has no name of a picture", file->name, file->key);
    }
    if (count < least) return fail(MERLIN_WRONG_USE, "%s %d pictures or more, not %d", wants, least, count);
    if (count > limits->pictures)
        return fail(MERLIN_WRONG_USE, "stereo takes %d pictures at most here, not %d", limits->pictures, count);
    return OK;
}

static status read_values(const form *f, stereo_request *r)
{
    enum { UNIVERSAL = MERLIN_STEREO_NFPS + 1 };
    static const char *const methods[] = {"auto", "ls", "robust", "near", "semi", "uncalibrated", "nfps", "universal"};
    int method = MERLIN_STEREO_AUTO;
    status s = form_choice(f, "method", methods, sizeof methods / sizeof *methods, &method);
    r->universal = method == UNIVERSAL;
    r->params.method = r->universal ? MERLIN_STEREO_AUTO : (merlin_stereo_method)method;
    if (s == OK) s = form_flag(f, "keep_edges", &r->params.keep_edges);
    if (s == OK) s = form_flag(f, "near", &r->near_lights);
    if (s == OK) s = form_flag(f, "unknown", &r->unknown_lights);
    if (s == OK) s = form_flag(f, "linear", &r->linear);
    if (s == OK && form_value(f, "fov")) s = form_real(f, "fov", 1, 150, &r->field_of_view);
    if (s == OK && form_value(f, "distance")) s = form_real(f, "distance", 1e-6, 1e6, &r->distance);
    return s;
}

/* The fields of pictures under many lights, and those of one photograph. */
static const form_key of_pictures[] = {{"pictures", FORM_FILE, SIZE_MAX},
                                       {"lights", FORM_FILE, 1},
                                       {"mask", FORM_FILE, 1},
                                       {"ambient", FORM_FILE, 1},
                                       {"method", FORM_VALUE, 1},
                                       {"keep_edges", FORM_VALUE, 1},
                                       {"near", FORM_VALUE, 1},
                                       {"unknown", FORM_VALUE, 1},
                                       {"linear", FORM_VALUE, 1},
                                       {"fov", FORM_VALUE, 1},
                                       {"distance", FORM_VALUE, 1},
                                       {"point", FORM_VALUE, MERLIN_MOST_POINTS},
                                       {"box", FORM_VALUE, 1},
                                       {"size", FORM_VALUE, 1},
                                       {"views", FORM_VALUE, 1},
                                       {0}};
static const form_key of_photo[] = {PHOTO_KEYS, {"method", FORM_VALUE, 1}, {"keep_edges", FORM_VALUE, 1}, {0}};

/* Refuses what does not go together, as the command does. */
static status check_together(const form *f, const stereo_request *r)
{
    const merlin_stereo_method m = r->params.method;
    if (r->photo && m != MERLIN_STEREO_AUTO && m != MERLIN_STEREO_NEAR && m != MERLIN_STEREO_UNCALIBRATED)
        return fail(MERLIN_WRONG_USE,
                    "stereo of a photo, which is relit by near lights, has the methods auto, near and "
                    "uncalibrated");
    const bool finds = r->universal || m == MERLIN_STEREO_UNCALIBRATED;
    if (r->photo && r->universal) return fail(MERLIN_WRONG_USE, "method universal is for pictures, not for a photo");
    if (!r->photo && finds && (form_find_file(f, "lights") || r->near_lights))
        return fail(MERLIN_WRONG_USE, "method %s takes no lights and no near: it finds both kinds of lights",
                    r->universal ? "universal" : "uncalibrated");
    return OK;
}

/* Takes what only the model's way with pictures has use for. */
static status read_seeing(const form *f, stereo_request *r)
{
    static const char *const of_model[] = {"point", "box", "size", "views"};
    if (r->universal && (r->params.keep_edges || r->distance > 0))
        return fail(MERLIN_WRONG_USE, "%s is for pictures with lights, or by method uncalibrated",
                    r->params.keep_edges ? "keep_edges" : "distance");
    if (r->universal) return photo_form_seeing(f, &r->photo_params);
    for (size_t i = 0; i < sizeof of_model / sizeof *of_model; i++)
        if (form_value(f, of_model[i]))
            return fail(MERLIN_WRONG_USE, "%s is for a photo, or pictures without lights", of_model[i]);
    return OK;
}

static status check_capture(const form *f, const work_limits *limits, stereo_request *r)
{
    const bool unknown = r->unknown_lights || !form_find_file(f, "lights");
    r->universal |= unknown && !r->near_lights && r->params.method == MERLIN_STEREO_AUTO;
    status s = check_pictures(f, limits, r->universal);
    return s == OK ? read_seeing(f, r) : s;
}

static status check(const form *f, const work_limits *limits, void **request)
{
    stereo_request *r = calloc(1, sizeof *r);
    *request = r;
    if (!r) return fail(MERLIN_NO_MEMORY, "no memory for a request");
    r->photo = form_find_file(f, "photo") != NULL;
    status s = form_check(f, r->photo ? "stereo of a photo" : "stereo", r->photo ? of_photo : of_pictures);
    if (s == OK) s = read_values(f, r);
    if (s == OK) s = check_together(f, r);
    if (s != OK) return s;
    return r->photo ? photo_form_params(f, &r->photo_params) : check_capture(f, limits, r);
}

/* ---- the work ---- */

/* Returns the path of an uploaded file, or NULL. */
static const char *path_of(const work_context *w, const char *key, char path[PATH_MAX])
{
    const form_file *file = form_find_file(w->form, key);
    return file ? store_path(w->store, w->form->id, STORE_IN, file->name, path) : NULL;
}

static status read_capture(const work_context *w, const stereo_request *r, merlin_capture **out)
{
    char lights[PATH_MAX], mask[PATH_MAX], ambient[PATH_MAX], folder[PATH_MAX];
    const merlin_capture_files files = {.lights = path_of(w, "lights", lights),
                                        .mask = path_of(w, "mask", mask),
                                        .ambient = path_of(w, "ambient", ambient),
                                        .near_lights = r->near_lights,
                                        .unknown_lights = r->unknown_lights || !form_find_file(w->form, "lights"),
                                        .linear = r->linear,
                                        .field_of_view = r->field_of_view,
                                        .distance = r->distance,
                                        .stop = w->stop,
                                        .progress = w->progress,
                                        .progress_context = w->progress_context};
    return merlin_capture_read(store_path(w->store, w->form->id, STORE_IN, NULL, folder), &files, out);
}

/* The page that lights it, of the maps that it is relit by. */
static status write_view(const work_context *w, const merlin_surface *surface)
{
    const merlin_view_params view = {.name = "surface"};
    merlin_maps maps = {.size = 0};
    char path[PATH_MAX];
    status s = merlin_maps_from_surface(surface, &maps);
    if (s == OK) s = merlin_view_write(&maps, &view, store_path(w->store, w->form->id, STORE_OUT, "viewer.html", path));
    merlin_maps_free(&maps);
    return s;
}

static status write_surface(const work_context *w, const merlin_surface *surface)
{
    const merlin_write_params write = {
        .in_place = 1, .stop = w->stop, .progress = w->progress, .progress_context = w->progress_context};
    merlin_mesh mesh = {.vertex_count = 0};
    char folder[PATH_MAX];
    status s = merlin_surface_write(surface, NULL, &write, store_path(w->store, w->form->id, STORE_OUT, NULL, folder));
    if (s == OK) s = write_view(w, surface);
    if (s == OK) s = merlin_mesh_from_surface(surface, &mesh);
    if (s == OK) s = mesh_files_write(w, &mesh);
    merlin_mesh_free(&mesh);
    return s;
}

/* Makes maps of pictures whose lights nobody knows, as the command does. */
static status see_together(const work_context *w, const stereo_request *r)
{
    merlin_params params = r->photo_params;
    merlin_capture *capture = NULL;
    merlin_maps maps = {.size = 0};
    params.fov = r->field_of_view;
    params.near_network = w->near;
    params.stop = w->stop;
    params.progress = w->progress;
    params.progress_context = w->progress_context;
    status s = read_capture(w, r, &capture);
    if (s == OK) s = merlin_maps_from_capture(w->model, capture, &params, &maps);
    merlin_capture_free(capture);
    if (s == OK) s = maps_files_write(w, &maps, (maps_files){"object", 1});
    merlin_maps_free(&maps);
    return s;
}

static status solve_pictures(const work_context *w, const stereo_request *r, const merlin_stereo_params *params,
                             merlin_surface *out)
{
    merlin_capture *capture = NULL;
    if (params->method == MERLIN_STEREO_NFPS && !w->near)
        return fail(MERLIN_WRONG_USE, "method nfps: this server has no weights merlin-nfps; near solves without them");
    status s = read_capture(w, r, &capture);
    if (s == OK) s = merlin_stereo_by_network(w->near, capture, params, out);
    merlin_capture_free(capture);
    return s;
}

static status solve_photo(const work_context *w, const stereo_request *r, const merlin_stereo_params *params,
                          merlin_surface *out)
{
    merlin_maps maps;
    status s = photo_form_estimate(w, &r->photo_params, &maps);
    if (s != OK) return s;
    s = merlin_stereo_from_maps(w->model, &maps, params, out);
    merlin_maps_free(&maps);
    return s;
}

static status run(const work_context *w, const void *request)
{
    const stereo_request *r = request;
    merlin_surface surface = {.light_count = 0};
    merlin_stereo_params params = r->params;
    if (r->universal) return see_together(w, r);
    params.stop = w->stop;
    params.progress = w->progress;
    params.progress_context = w->progress_context;
    status s = (r->photo ? solve_photo : solve_pictures)(w, r, &params, &surface);
    if (s != OK) return s;
    s = write_surface(w, &surface);
    merlin_surface_free(&surface);
    return s;
}

static const work_stage stages[] = {
    {"reading", 0.1f}, {"finding the object", 0.05f}, {"estimating", 0.05f}, {"refining", 0.05f},
    {"solving", 0.5f}, {"integrating", 0.1f},         {"writing", 0.15f},    {0}};
const work_kind work_stereo = {.name = "stereo", .stages = stages, .check = check, .run = run};
