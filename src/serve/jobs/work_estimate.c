/* SPDX-License-Identifier: MIT */
/* Makes maps of a photograph: the files of merlin estimate, and the viewer's page. */
#include <stdlib.h>
#include <string.h>

#include "serve/jobs/maps_files.h"
#include "serve/jobs/photo_form.h"
#include "serve/jobs/work_kinds.h"

typedef struct estimate_request {
    merlin_params params;
    int view, mesh;
} estimate_request;

static status check(const form *f, const work_limits *limits, void **request)
{
    static const form_key known[] = {PHOTO_KEYS, {"view", FORM_VALUE, 1}, {"mesh", FORM_VALUE, 1}, {0}};
    estimate_request *r = calloc(1, sizeof *r);
    (void)limits;
    *request = r;
    if (!r) return fail(MERLIN_NO_MEMORY, "no memory for a request");
    r->view = 1;
    status s = form_check(f, "estimate", known);
    if (s == OK) s = photo_form_params(f, &r->params);
    if (s == OK) s = form_flag(f, "mesh", &r->mesh);
    return s == OK ? form_flag(f, "view", &r->view) : s;
}

/* Copies the photograph's name without its ending. */
static void name_of(const form *f, char name[SAFE_NAME])
{
    memcpy(name, form_find_file(f, "photo")->name, SAFE_NAME);
    char *ending = strrchr(name, '.');
    if (ending && ending != name) *ending = 0;
}

static status run(const work_context *w, const void *request)
{
    const estimate_request *r = request;
    char name[SAFE_NAME];
    merlin_maps maps;
    status s = photo_form_estimate(w, &r->params, &maps);
    if (s != OK) return s;
    name_of(w->form, name);
    s = maps_files_write(w, &maps, (maps_files){r->view ? name : NULL, r->mesh});
    merlin_maps_free(&maps);
    return s;
}

static const work_stage stages[] = {{"reading", 0.1f},    {"finding the object", 0.15f},
                                    {"estimating", 0.3f}, {"refining", 0.2f},
                                    {"writing", 0.25f},   {0}};
const work_kind work_estimate = {.name = "estimate", .stages = stages, .check = check, .run = run};
