/* SPDX-License-Identifier: MIT */
#include "cli/estimate_sequence.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/file.h"
#include "base/json/json_put.h"
#include "base/progress.h"
#include "base/warnings.h"
#include "cli/check_replaced.h"
#include "cli/expect.h"
#include "cli/left_files.h"
#include "cli/page.h"
#include "cli/written.h"
#include "command/check_files.h"
#include "command/cli.h"
#include "command/json_line.h"
#include "command/photo_hint.h"
#include "merlin/merlin.h"

#define REPORT_FILE "sequence.json"

/* ---- what is a sequence ---- */

status estimate_sequence_check(estimate_request *r, int count, char *const *names)
{
    for (int i = 0; i < count; i++) {
        const int kind = merlin_frames_are(names[i]);
        if (kind && count > 1)
            return fail(MERLIN_WRONG_USE, "%s is a %s, which comes alone", names[i],
                        kind == 1 ? "video" : "pattern of a sequence's names");
        r->sequence |= kind != 0;
    }
    if (!r->sequence)
        return r->smooth < 0 ? OK : fail(MERLIN_WRONG_USE, "--smooth is for a video, or for pictures with --sequence");
    if (r->share.of || r->resume)
        return fail(MERLIN_WRONG_USE, "the frames of a sequence depend on those before: no --share and no --resume");
    if (r->meshes.count)
        return fail(MERLIN_WRONG_USE,
                    "--mesh %s names the mesh of one photograph; of a sequence --mesh alone writes a mesh.glb in each "
                    "frame's folder",
                    r->meshes.at[0]);
    for (int i = 0; i < count && count > 1; i++)
        if (file_is_folder(names[i]))
            return fail(MERLIN_WRONG_USE, "the folder %s is a sequence alone, not with others", names[i]);
    return photo_check_hint(&r->params.hint, r->mask, false);
}

static status open_frames(const estimate_request *r, int count, char *const *names, merlin_frames **out)
{
    const bool alone = count == 1 && (file_is_folder(names[0]) || merlin_frames_are(names[0]));
    return alone ? merlin_frames_open(names[0], r->mask, out)
                 : merlin_frames_open_pictures((const char *const *)names, (size_t)count, r->mask, out);
}

/* Composes the default place of the results: the name without number and ending + ".merlin". */
static char *output_of(const char *name)
{
    const char *last = file_name_of(name);
    const bool dots = strcmp(last, ".") == 0 || strcmp(last, "..") == 0; /* a folder by no name of its own */
    char *stem = dots ? realpath(name, NULL) : strdup(name), *made = NULL;
    if (!stem) return NULL;
    size_t length = strlen(stem);
    const size_t folder = (size_t)(file_name_of(stem) - stem);
    if (file_is_folder(stem)) {
        while (length > 1 && stem[length - 1] == '/')
            length--;
    } else {
        const char *dot = strrchr(stem + folder, '.'), *pattern = strpbrk(stem + folder, "%#");
        if (dot && dot > stem + folder) length = (size_t)(dot - stem);
        if (merlin_frames_are(name) == 2 && pattern) length = (size_t)(pattern - stem);
        while (merlin_frames_are(name) != 1 && length > folder &&
               (isdigit((unsigned char)stem[length - 1]) || strchr("_-. ", stem[length - 1])))
            length--;
    }
    stem[length] = 0;
    if (asprintf(&made, "%s%s.merlin", stem, length > folder || file_is_folder(name) ? "" : "frames") < 0) made = NULL;
    free(stem);
    return made;
}

/* ---- the work ---- */

typedef struct sequence_work {
    estimate_request *request;
    const char *input; /* name of the first photograph, or of the video, pattern or folder */
    char *output;
    merlin_frames *frames;
    merlin_sequence *sequence;
    long done;
    staged_files written;
    double began;
} sequence_work;

static status open_models(estimate_request *r)
{
    status s = photo_find_models(r->model_name, &r->weights, &r->flash_weights);
    return s == OK ? photo_open_models(r->weights, r->flash_weights, &r->model) : s;
}

static void plan(const sequence_work *w, const merlin_frames_head *head)
{
    const estimate_request *r = w->request;
    const double pixels = (double)head->width * head->height;
    const double count = fmax((double)head->count, (double)w->done + 1), done = (double)w->done;
    stage_cost stages[STAGE_BAR_MOST];
    size_t used = expect_estimate(pixels, stages, 0);
    stages[used++] = (stage_cost){"writing", expect_maps_written(pixels, r->mesh) + (r->html ? page_cost(pixels) : 0)};
    stage_bar_plan(r->bar, stages, used);
    stage_bar_span(r->bar, done / count, (done + 1) / count, (size_t)done + 1, (size_t)count);
    watch_tell(r->watch, "reading", 0);
}

/* Removes the list of an earlier run, whose frames are about to be replaced. */
static status drop_report(const sequence_work *w)
{
    char *path = file_join(w->output, REPORT_FILE);
    if (!path) return fail(MERLIN_NO_MEMORY, "no memory for file names");
    const bool failed = file_exists(path) && unlink(path) != 0;
    status s = failed ? fail(MERLIN_CANNOT_WRITE, "cannot replace %s", path) : OK;
    free(path);
    return s;
}

/* Writes the files of a frame, which is not reported without them. */
static status write_frame(sequence_work *w, const estimate_write *files, merlin_maps *maps)
{
    status s = w->done == 0 ? drop_report(w) : OK;
    if (s == OK) s = estimate_write_files(files, maps, false, &w->written);
    if (s != OK) merlin_sequence_drop_last(w->sequence);
    merlin_maps_free(maps);
    return s;
}

/* Estimates a frame, which is empty afterwards, and writes its folder: all of its files or none. */
static status do_frame(sequence_work *w, merlin_frame *frame)
{
    char name[64];
    const char *const inputs[STAGING_MOST_INPUTS] = {frame->path};
    merlin_maps maps;
    merlin_sequence_folder(frame->number, name, sizeof name);
    char *folder = file_join(w->output, name), *label = NULL;
    const char *path = frame->path;
    if (asprintf(&label, "%s, frame %ld", path, frame->number) < 0) label = NULL;
    status s = folder && label ? check_replaced(folder, false) : fail(MERLIN_NO_MEMORY, "no memory for file names");
    if (s == OK) {
        s = merlin_sequence_estimate(w->sequence, frame, &maps, NULL);
        if (s != OK && s != MERLIN_STOPPED) s = fail_in(s, "%s", label);
    }
    if (s == OK) {
        const estimate_write files = {w->request, label, folder, inputs, NULL};
        s = write_frame(w, &files, &maps);
    }
    merlin_frame_free(frame);
    free(label);
    free(folder);
    if (s == OK) w->done++;
    return s;
}

/* Adds sequence.json to what was written. */
static status write_report(sequence_work *w)
{
    staging *t;
    status s = staging_begin(w->output, NULL, &t);
    if (s != OK) return s;
    s = merlin_sequence_write(w->sequence, merlin_frames_about(w->frames), staging_folder(t));
    return s == OK ? staging_commit(t, &w->written) : staging_abort(t, s);
}

static status do_frames(sequence_work *w)
{
    merlin_frame frame = {.number = 0};
    for (;;) {
        plan(w, merlin_frames_about(w->frames));
        status s = cli_interrupted() ? fail(MERLIN_STOPPED, "stopped") : merlin_frames_next(w->frames, &frame);
        if (s != OK || !frame.image.data) return s;
        s = do_frame(w, &frame);
        if (s != OK) return s;
    }
}

/* ---- what is said ---- */

static void find_doubts(const sequence_work *w, warnings *doubts)
{
    merlin_sequence_warnings(w->sequence, merlin_frames_about(w->frames), doubts);
    left_frames_warn(w->output, &w->written, doubts);
}

static status print_json(const sequence_work *w, const warnings *doubts)
{
    char *text = NULL;
    status s = merlin_sequence_report(w->sequence, merlin_frames_about(w->frames), &text);
    if (s != OK) return s;
    cJSON *report = cJSON_Parse(text);
    free(text);
    if (!report) return fail(MERLIN_NO_MEMORY, "no memory for the report");
    json_line_warnings(report, doubts);
    json_put_text(report, "input", w->input);
    json_line_files(report, w->output, &w->written);
    json_put_number(report, "seconds_total", clock_seconds() - w->began);
    s = json_line_print(report);
    cJSON_Delete(report);
    return s;
}

static void print_words(const sequence_work *w)
{
    char amount[WRITTEN_WORDS];
    merlin_flicker f;
    merlin_sequence_flicker(w->sequence, &f);
    printf("%s: %ld frame%s in %s (%.1f s, %s)", w->input, w->done, w->done == 1 ? "" : "s", w->output,
           clock_seconds() - w->began, written_words(&w->written, amount));
    if (f.pairs)
        printf(", from frame to frame albedo differs by %.4f (before smoothing %.4f), normals by %.2f degrees (%.2f)",
               f.after.albedo, f.before.albedo, f.after.normal, f.before.normal);
    printf("\n");
}

static status announce(const sequence_work *w)
{
    enum { TOLD = 4 };
    const estimate_request *r = w->request;
    warnings doubts;
    stage_bar_hide(r->bar);
    find_doubts(w, &doubts);
    status s = r->json ? print_json(w, &doubts) : OK;
    if (!r->json && !r->quiet) print_words(w);
    if (!r->quiet) warnings_print(&doubts, "estimate", w->input, TOLD);
    return s;
}

/* Says what remains of a sequence that ended early. */
static status explain(const sequence_work *w, status s)
{
    if (s == MERLIN_STOPPED && w->done)
        return fail(s, "interrupted; frames of %s that are complete in %s: %ld", w->input, w->output, w->done);
    if (s == MERLIN_STOPPED) return fail(s, "interrupted; nothing was written for %s", w->input);
    char words[1024];
    snprintf(words, sizeof words, "%s", status_message());
    if (!w->done) return s;
    return fail(s, "%s; frames before it that are complete in %s: %ld", words, w->output, w->done);
}

static status run(sequence_work *w, int count, char *const *names)
{
    estimate_request *r = w->request;
    const merlin_sequence_params how = {.smooth = r->smooth > 0 ? r->smooth : r->smooth == 0, .apart = r->smooth == 0};
    w->output = r->output ? strdup(r->output) : output_of(names[0]);
    status s = w->output ? check_named("mask", r->mask) : fail(MERLIN_NO_MEMORY, "no memory for file names");
    for (int i = 0; i < count && s == OK && merlin_frames_are(names[i]) != 2; i++)
        s = check_named("photograph, video or folder", names[i]);
    if (s == OK) s = open_frames(r, count, names, &w->frames);
    if (s == OK) s = check_output(w->output);
    if (s == OK) s = open_models(r);
    r->params.progress = r->watch->tell;
    r->params.progress_context = r->watch->context;
    if (s == OK) s = merlin_sequence_new(r->model, &r->params, &how, &w->sequence);
    if (s != OK) return s;
    s = do_frames(w);
    if (s != OK) {
        s = explain(w, s);
        char words[1200];
        snprintf(words, sizeof words, "%s", status_message());
        if (w->done) (void)write_report(w); /* of those that are there */
        return fail(s, "%s", words);
    }
    s = write_report(w);
    return s == OK ? announce(w) : s;
}

int estimate_sequence(const estimate_request *asked, int count, char *const *names)
{
    stage_bar bar;
    stage_bar_begin(&bar, asked->quiet);
    const watch shown = stage_bar_watch(&bar);
    estimate_request r = *asked;
    r.bar = &bar;
    r.watch = &shown;
    sequence_work w = {.request = &r, .input = names[0], .began = clock_seconds()};
    status s = run(&w, count, names);
    stage_bar_end(&bar);
    merlin_sequence_free(w.sequence);
    merlin_frames_close(w.frames);
    merlin_files_free(&w.written);
    merlin_model_close(r.model);
    free(r.weights);
    free(r.flash_weights);
    free(w.output);
    return s == OK ? 0 : cli_fail("estimate", s);
}
