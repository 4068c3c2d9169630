/* SPDX-License-Identifier: MIT */
/* Finds the object of a photograph before any estimate: mask.png and photo.png, both small enough for display, on which
 * a person corrects the mask. */
#include <stdlib.h>
#include <string.h>

#include "base/json/json_put.h"
#include "base/warnings.h"
#include "serve/jobs/photo_form.h"
#include "serve/jobs/resized.h"
#include "serve/jobs/work_kinds.h"

enum { SIDE = 1280, LEAST_SIDE = 64, MOST_SIDE = 4096 };
static const float SURE = 0.5f; /* confidence below which estimate warns, too */

typedef struct mask_request {
    merlin_hint hint;
    int side;
} mask_request;

static status check(const form *f, const work_limits *limits, void **request)
{
    static const form_key known[] = {PHOTO_HINT_KEYS, {"side", FORM_VALUE, 1}, {0}};
    mask_request *r = calloc(1, sizeof *r);
    (void)limits;
    *request = r;
    if (!r) return fail(MERLIN_NO_MEMORY, "no memory for a request");
    r->side = SIDE;
    status s = form_check(f, "mask", known);
    if (s == OK && !form_find_file(f, "photo")) s = fail(MERLIN_WRONG_USE, "no file \"photo\" was sent");
    if (s == OK) s = photo_form_hint(f, &r->hint);
    return s == OK ? form_integer(f, "side", LEAST_SIDE, MOST_SIDE, &r->side) : s;
}

static status write_reduced(const work_context *w, const merlin_image *image, int side, const char *name)
{
    merlin_image reduced = {0};
    char path[PATH_MAX];
    status s = resized_reduce(image, side, &reduced);
    if (s == OK) s = merlin_image_write(store_path(w->store, w->form->id, STORE_OUT, name, path), &reduced);
    merlin_image_free(&reduced);
    return s;
}

/* Undoes the conversion from sRGB, which would change partial coverage. */
static void bend_back(merlin_image *mask)
{
    for (size_t i = 0, n = (size_t)mask->width * mask->height; i < n; i++)
        mask->data[i] = mask->data[i] >= 0.5f ? 1 : 0;
}

static status run(const work_context *w, const void *request)
{
    const mask_request *r = request;
    merlin_image photo;
    merlin_object object;
    status s = photo_form_read(w, &r->hint, &photo, &object);
    if (s != OK) return s;
    warnings doubts = {0};
    if (object.confidence < SURE)
        warnings_add(
            &doubts, "object_unsure",
            "the object was found with little confidence: correct its mask, or say where it is by point or box");
    json_put_item(w->report, "warnings", warnings_json(&doubts));
    json_put_number(w->report, "width", photo.width);
    json_put_number(w->report, "height", photo.height);
    json_put_text(w->report, "mask_source", object.source == MERLIN_MASK_GIVEN ? "given" : "found");
    json_put_number(w->report, "mask_confidence", object.confidence);
    w->progress(w->progress_context, "writing", 0);
    bend_back(&object.mask);
    s = write_reduced(w, &photo, r->side, "photo.png");
    if (s == OK) s = write_reduced(w, &object.mask, r->side, "mask.png");
    merlin_image_free(&photo);
    merlin_object_free(&object);
    return s;
}

static const work_stage stages[] = {{"reading", 0.3f}, {"finding the object", 0.4f}, {"writing", 0.3f}, {0}};
const work_kind work_mask = {.name = "mask", .stages = stages, .check = check, .run = run};
