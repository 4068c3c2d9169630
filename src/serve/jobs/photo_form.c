/* SPDX-License-Identifier: MIT */
#include "serve/jobs/photo_form.h"

#include <string.h>

#include "serve/jobs/resized.h"

/* ---- values ---- */

status photo_form_hint(const form *f, merlin_hint *hint)
{
    enum { FARTHEST = 1 << 20 };
    float at[4];
    status s = OK;
    *hint = (merlin_hint){.point_count = 0};
    for (int i = 0; i < MERLIN_MOST_POINTS && form_value_at(f, "point", (size_t)i) && s == OK; i++) {
        s = form_numbers(f, "point", (size_t)i, 0, FARTHEST, 2, at);
        if (s != OK) break;
        hint->point[i].x = (int)at[0];
        hint->point[i].y = (int)at[1];
        hint->point_count = i + 1;
    }
    if (s != OK || !form_value(f, "box")) return s;
    s = form_numbers(f, "box", 0, 0, FARTHEST, 4, at);
    if (s != OK) return s;
    if (at[2] < 1 || at[3] < 1) return fail(MERLIN_WRONG_USE, "box wants a width and a height of one or more");
    hint->box.x = (int)at[0];
    hint->box.y = (int)at[1];
    hint->box.width = (int)at[2];
    hint->box.height = (int)at[3];
    return OK;
}

static status read_exposure(const form *f, merlin_params *params)
{
    const char *text = form_value(f, "exposure");
    if (!text || strcmp(text, "auto") == 0) return OK;
    params->auto_exposure = 0;
    return form_real(f, "exposure", -20, 20, &params->exposure);
}

static status read_size(const form *f, merlin_params *params)
{
    status s = form_integer(f, "size", MERLIN_LEAST_SIZE, MERLIN_LARGEST_SIZE, &params->size);
    if (s != OK || params->size % MERLIN_SIZE_STEP == 0) return s;
    return fail(MERLIN_WRONG_USE, "size wants a multiple of %d, not %d", MERLIN_SIZE_STEP, params->size);
}

status photo_form_seeing(const form *f, merlin_params *params)
{
    *params = merlin_params_default();
    status s = photo_form_hint(f, &params->hint);
    if (s == OK && form_find_file(f, "mask") && (form_value(f, "point") || form_value(f, "box")))
        s = fail(MERLIN_WRONG_USE, "point and box help where there is no mask");
    if (s == OK) s = read_size(f, params);
    return s == OK ? form_integer(f, "views", 1, 8, &params->views) : s;
}

status photo_form_params(const form *f, merlin_params *params)
{
    if (!form_find_file(f, "photo")) return fail(MERLIN_WRONG_USE, "no file \"photo\" was sent");
    status s = photo_form_seeing(f, params);
    if (s == OK && form_value(f, "fov")) s = form_real(f, "fov", 1, 150, &params->fov);
    if (s == OK) s = form_flag(f, "flash", &params->flash);
    return s == OK ? read_exposure(f, params) : s;
}

status photo_form_refuse(const form *f, const char *what)
{
    static const form_key of_photo[] = {PHOTO_KEYS, {0}};
    for (const form_key *k = of_photo; k->name; k++)
        if (form_value(f, k->name) || form_find_file(f, k->name))
            return fail(MERLIN_WRONG_USE, "%s takes no %s, which is of a photo", what, k->name);
    return OK;
}

/* ---- the photograph ---- */

static status check_pixels(const work_context *w, const merlin_image *photo)
{
    const double millions = 1e-6 * photo->width * photo->height;
    if (millions <= w->limits->megapixels) return OK;
    return fail(MERLIN_BAD_INPUT, "the photograph has %.1f million pixels, and this server takes %g at most", millions,
                w->limits->megapixels);
}

static status read_both(const work_context *w, const char *path, merlin_image *photo, merlin_image *mask)
{
    const form_file *painted = form_find_file(w->form, "mask");
    char mask_path[PATH_MAX];
    status s = merlin_image_read(path, photo, painted ? NULL : mask);
    if (s == OK) s = check_pixels(w, photo);
    if (s != OK || !painted) return s;
    s = merlin_mask_read(store_path(w->store, w->form->id, STORE_IN, painted->name, mask_path), mask);
    return s == OK ? resized_enlarge(mask, photo->width, photo->height) : s;
}

static const char *photo_path(const work_context *w, char path[PATH_MAX])
{
    return store_path(w->store, w->form->id, STORE_IN, form_find_file(w->form, "photo")->name, path);
}

status photo_form_read(const work_context *w, const merlin_hint *hint, merlin_image *photo, merlin_object *object)
{
    const bool hinted = hint && (hint->point_count > 0 || hint->box.width > 0);
    merlin_image mask = {0};
    merlin_shot shot = {.reduced = 1};
    char path[PATH_MAX];
    *photo = (merlin_image){0};
    *object = (merlin_object){.confidence = 0};
    w->progress(w->progress_context, "reading", 0);
    status s = read_both(w, photo_path(w, path), photo, &mask);
    if (s == OK && w->stop()) s = fail(MERLIN_STOPPED, "stopped");
    if (s == OK) w->progress(w->progress_context, "finding the object", 0);
    if (s == OK && hinted) (void)merlin_shot_read(path, &shot);
    merlin_hint in_file = hinted ? *hint : (merlin_hint){.point_count = 0};
    in_file.reduced = shot.reduced;
    if (s == OK) s = merlin_object_find(photo, mask.data && !hinted ? &mask : NULL, &in_file, object);
    merlin_image_free(&mask);
    if (s != OK) merlin_image_free(photo);
    return s;
}

status photo_form_estimate(const work_context *w, const merlin_params *params, merlin_maps *maps)
{
    merlin_params own = *params;
    merlin_image photo;
    merlin_object object;
    char path[PATH_MAX];
    *maps = (merlin_maps){.size = 0};
    status s = photo_form_read(w, &params->hint, &photo, &object);
    if (s != OK) return s;
    (void)merlin_shot_read(photo_path(w, path), &own.shot);
    memset(&own.hint, 0, sizeof own.hint); /* it is not needed any more */
    own.stop = w->stop;
    own.progress = w->progress;
    own.progress_context = w->progress_context;
    s = merlin_estimate_object(w->model, &photo, &object, &own, maps);
    merlin_object_free(&object);
    merlin_image_free(&photo);
    return s;
}
