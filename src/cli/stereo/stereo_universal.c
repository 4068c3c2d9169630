/* SPDX-License-Identifier: MIT */
#include "cli/stereo/stereo_universal.h"

#include <cjson/cJSON.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/json/json_put.h"
#include "base/progress.h"
#include "cli/estimate_write.h"
#include "cli/written.h"
#include "command/cli.h"
#include "command/json_line.h"
#include "command/photos.h"

/* Opens the weights that were asked for, which stand alone, or those for any light and what helps them; flashes have no
 * network of their own here. */
static status open_models(const universal_request *r, merlin_model **out, merlin_near_network **near)
{
    char *weights = NULL, *flash = NULL;
    status s = photo_find_models(r->weights, &weights, &flash);
    if (s == OK) s = merlin_model_open(weights, out);
    if (s == OK) s = photo_add_several(flash, *out);
    if (s == OK && flash) s = photo_open_near(NULL, false, near);
    free(weights);
    free(flash);
    if (s == OK) return OK;
    merlin_model_close(*out);
    *out = NULL;
    return s;
}

static status print_json(const universal_request *r, const merlin_maps *maps, const staged_files *written,
                         const warnings *doubts, double seconds)
{
    char *text;
    status s = merlin_maps_report(maps, &text);
    if (s != OK) return s;
    cJSON *report = cJSON_Parse(text);
    json_line_warnings(report, doubts);
    json_put_text(report, "input", r->input);
    json_line_files(report, r->files->folder, written);
    json_put_number(report, "seconds_total", seconds);
    s = json_line_print(report);
    cJSON_Delete(report);
    free(text);
    return s;
}

/* Writes which light would tell most, as long as there are few photographs. */
static const char *advice_on(const merlin_maps *maps, char *text, size_t size)
{
    enum { PLENTY = 16 };
    char lamp[MERLIN_LIGHT_WORDS];
    if (maps->photographs < 2 || maps->photographs >= PLENTY) return "";
    merlin_lamp_words(maps->further_light, lamp, sizeof lamp);
    snprintf(text, size, "; next, %s, tells most", lamp);
    return text;
}

static status announce(const universal_request *r, const merlin_maps *maps, const staged_files *written, double seconds)
{
    enum { TOLD = 3, ADVICE = MERLIN_LIGHT_WORDS + 32 };
    char amount[WRITTEN_WORDS], advice[ADVICE];
    warnings doubts;
    status s = OK;
    stage_bar_hide(r->bar);
    estimate_find_doubts(r->files->page, r->files->folder, maps, written, &doubts);
    if (r->json)
        s = print_json(r, maps, written, &doubts, seconds);
    else if (!r->quiet)
        printf("%s: %s (%.2f s, %s)%s\n", r->input, r->files->folder, seconds, written_words(written, amount),
               advice_on(maps, advice, sizeof advice));
    if (!r->quiet) warnings_print(&doubts, "stereo", r->input, TOLD);
    return s;
}

static status write(const universal_request *r, merlin_model *model, const merlin_maps *maps, staged_files *written)
{
    const stereo_files *f = r->files;
    const estimate_request as = {
        .mesh = f->mesh.count == 0, .html = f->page, .meshes = f->mesh, .model = model, .watch = r->watch};
    return estimate_write_files(&(estimate_write){&as, r->input, f->folder, f->inputs, NULL}, maps, true, written);
}

status stereo_universal(const universal_request *r, merlin_capture *capture)
{
    merlin_model *model = NULL;
    merlin_near_network *near = NULL;
    merlin_maps maps = {0};
    staged_files written = {0};
    merlin_params params = r->params;
    status s = open_models(r, &model, &near);
    params.near_network = near;
    if (s == OK) s = merlin_maps_from_capture(model, capture, &params, &maps);
    merlin_near_network_close(near);
    merlin_capture_free(capture);
    if (s == OK) s = write(r, model, &maps, &written);
    if (s == OK) s = announce(r, &maps, &written, clock_seconds() - r->began);
    merlin_files_free(&written);
    merlin_maps_free(&maps);
    merlin_model_close(model);
    return s;
}
