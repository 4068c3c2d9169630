/* SPDX-License-Identifier: MIT */
/* merlin estimate: photographs to maps. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "base/file.h"
#include "base/json/json_put.h"
#include "base/messages.h"
#include "base/progress.h"
#include "cli/check_replaced.h"
#include "cli/commands.h"
#include "cli/estimate_sequence.h"
#include "cli/estimate_write.h"
#include "cli/expect.h"
#include "cli/page.h"
#include "cli/stage_bar.h"
#include "cli/written.h"
#include "command/check_files.h"
#include "command/cli.h"
#include "command/json_line.h"
#include "command/options.h"
#include "command/photo_ahead.h"
#include "command/photo_hint.h"
#include "command/photos.h"
#include "command/standard_input.h"
#include "merlin/merlin.h"

static const char help[] =
    "usage: merlin estimate PHOTO... [options]\n"
    "       merlin estimate FOLDER   [options]\n"
    "       merlin estimate VIDEO | 'frame_%04d.png' | --sequence FOLDER [options]\n"
    "       merlin estimate - -o DIR [options]     (a photograph from standard input)\n\n"
    "Takes the object of a photograph apart: maps.exr with all maps, albedo.png, normal.png (16-bit, (n + 1)/2),\n"
    "roughness.png, depth.png (near is bright), mask.png, reconstruction.png, overview.png and report.json.\n"
    "Best with photographs taken by the camera's own flash.\n\n"
    "      --mask FILE      a picture of the photograph's size, white on the object, black beside it; for several\n"
    "                       photographs a folder with NAME.png, NAME_mask.png or the like for each. Without it:\n"
    "                       NAME.mask.png, NAME_mask.png, mask_NAME.png or the like beside the photograph NAME, of "
    "any\n"
    "                       picture's kind, else the photograph's alpha, else the object is searched for\n"
    "      --point X,Y      a pixel of the object, counted from the upper left corner of the upright photograph: helps "
    "the\n"
    "                       search for it where there is no mask; may be given again\n"
    "      --box X,Y,W,H    a box around the object, upper left corner and size in pixels, for the same\n"
    "  -o, --output DIR     where to (default: the photograph's name without ending + .merlin); for several\n"
    "                       photographs a folder each inside DIR\n"
    "      --model W        weights: merlin-any (any light), merlin-point (flash alone), merlin-env (flash in a "
    "room),\n"
    "                       or a file (default: $MERLIN_MODEL, else merlin-any, and merlin-point for photographs\n"
    "                       that it sees lit by a flash alone)\n"
    "      --size N         side of the square the network sees, a multiple of 32 from 64 to 512 (default): where the\n"
    "                       photograph has more than 256 pixels of the object, for finer normals; 256 is quicker\n"
    "      --views N        the mean over N of the square's 8 orientations (default 4): better maps, more time\n"
    "      --fov DEG        how wide the whole photograph is, in degrees (default: by its EXIF; unknown without)\n"
    "      --flash          the light was the camera's flash and nothing else; models of any light are told so\n"
    "      --exposure EV    brighten by EV stops for the network; default auto: only if too dark or too bright\n"
    "      --mesh [FILE]    write mesh.glb, too: the object's front with albedo, normals and roughness; or, of one\n"
    "                       photograph, FILE, which ends in .ply, .obj, .glb or .usda and may be given again\n"
    "      --html           write viewer.html, too: a page in which a browser lights the object (merlin view)\n"
    "      --sequence       the photographs, or those of FOLDER, are the numbered frames of one sequence, as a video's "
    "are:\n"
    "                       exposure, crop and maps stay steady, the object is followed; DIR/frame_0001 and so on, "
    "and\n"
    "                       sequence.json, which tells the flicker. --mask: the first frame's, or a folder of numbered "
    "ones\n"
    "      --smooth N       frames of the moving average, 1 to 100 (default 8); 0: each frame by itself\n"
    "      --share K/N      of several photographs the K-th of N equal shares alone, for as many machines\n"
    "  -r, --resume         of several, those alone that lack maps or files asked for, or have older ones than\n"
    "                       photograph and mask, another photograph's, or ones by other options\n"
    "      --json           a report as JSON on standard output, one line a photograph\n"
    "  -t, --threads N      how many threads work (default: one a processor)\n"
    "  -q, --quiet          no other output than errors\n"
    "  -h, --help           this text\n\n"
    "Several photographs: goes on after one that fails, and then exits with 1. What stands beside maps.exr in\n"
    "a FOLDER under the names above is no photograph.\n";

typedef estimate_request request;

static status take_standard_input(const request *r, int count, char **photos)
{
    for (int i = 0; i < count; i++) {
        if (strcmp(photos[i], "-") != 0) continue;
        if (count > 1) return fail(MERLIN_WRONG_USE, "a photograph from standard input comes alone");
        if (!r->output)
            return fail(MERLIN_WRONG_USE, "a photograph from standard input has no name to go by: say where to by -o");
        return standard_input_take(&photos[i]);
    }
    return OK;
}

static status parse(int *argc, char ***argv, request *r)
{
    const cli_option options[] = {
        {"mask", .text = &r->mask},
        {"point", .take = photo_take_point, .into = &r->params.hint, .many = true},
        {"box", .take = photo_take_box, .into = &r->params.hint},
        {"output", 'o', .folder = &r->output},
        {"model", .text = &r->model_name},
        {"size", .take = photo_take_size, .into = &r->params},
        {"views", .integer = &r->params.views, .low = 1, .high = 8},
        {"fov", .real = &r->params.fov, .low = 1, .high = 150},
        {"flash", .flag = &r->flash},
        {"exposure", .take = photo_take_exposure, .into = &r->params},
        {"mesh", .flag = &r->mesh, .take = mesh_take_name, .into = &r->meshes, .is_value = mesh_is_name, .many = true},
        {"html", .flag = &r->html},
        {"share", .take = photo_take_share, .into = &r->share},
        {"resume", 'r', .flag = &r->resume},
        {"sequence", .flag = &r->sequence},
        {"smooth", .integer = &r->smooth, .low = 0, .high = MERLIN_MOST_SMOOTH},
        {"json", .flag = &r->json},
        {"quiet", 'q', .flag = &r->quiet},
        {"help", 'h', .flag = &r->help},
        {0},
    };
    status s = cli_read_options(argc, argv, options);
    if (s != OK || r->help) return s;
    r->params.flash = r->flash;
    if (*argc == 0) return fail(MERLIN_WRONG_USE, "no photograph given");
    s = estimate_sequence_check(r, *argc, *argv);
    if (s != OK || r->sequence) return s;
    if (r->meshes.count && (*argc > 1 || file_is_folder((*argv)[0])))
        return fail(
            MERLIN_WRONG_USE,
            "--mesh %s names the mesh of one photograph; of several --mesh alone writes a mesh.glb in each one's "
            "folder",
            r->meshes.at[0]);
    s = photo_check_hint(&r->params.hint, r->mask, *argc > 1 || file_is_folder((*argv)[0]));
    return s != OK ? s : take_standard_input(r, *argc, *argv);
}

/* Times that the report in a photograph's folder cannot contain yet, in seconds. */
typedef struct lap_times {
    double start, model,
        compile;       /* times of the program: loading it, its weights, its network; only for the first photograph */
    double read, mask; /* times of the first photograph: waiting for both after all this, and 0 */
    double write, total;
} lap_times;

static status print_json(const request *r, const photo_job *job, const merlin_maps *maps, const staged_files *written,
                         const warnings *doubts, const lap_times *laps)
{
    char *text = NULL;
    status s = merlin_maps_report(maps, &text);
    if (s != OK) return s;
    cJSON *report = cJSON_Parse(text), *seconds = cJSON_GetObjectItem(report, "seconds");
    json_line_warnings(report, doubts);
    json_put_text(report, "input", standard_input_is(job->photo) ? "-" : job->photo);
    json_line_files(report, job->output, written);
    if (job->mask) json_put_text(report, "mask_file", job->mask);
    if (!*r->told) photo_list_put(r->photos, report);
    *r->told = true;
    json_put_number(seconds, "start", laps->start);
    json_put_number(seconds, "model", laps->model);
    json_put_number(seconds, "read", laps->read);
    json_put_number(seconds, "write", laps->write);
    json_put_number(report, "seconds_total", laps->total);
    s = json_line_print(report);
    cJSON_Delete(report);
    free(text);
    return s;
}

enum { LIT_BY = MERLIN_LIGHT_WORDS + 96 };

/* Describes the light that a model of any light estimates, or which of two models made the maps. */
static const char *lit_by(const request *r, const merlin_maps *maps, char words[LIT_BY])
{
    char light[MERLIN_LIGHT_WORDS];
    merlin_light_words(&maps->light, light, sizeof light);
    *words = 0;
    if (*light)
        snprintf(words, LIT_BY, ", lit by %s", light);
    else if (r->flash_weights && !maps->light.known)
        snprintf(words, LIT_BY, ", lit by a flash alone and so by %s", maps->model);
    return words;
}

static status announce(const request *r, const photo_job *job, const merlin_maps *maps, const staged_files *written,
                       const lap_times *laps)
{
    enum { TOLD = 3 };
    char amount[WRITTEN_WORDS], lit[LIT_BY];
    warnings doubts;
    status s = OK;
    stage_bar_hide(r->bar);
    estimate_find_doubts(r->html, job->output, maps, written, &doubts);
    if (r->json)
        s = print_json(r, job, maps, written, &doubts, laps);
    else if (!r->quiet)
        printf("%s: %s/overview.png (%.2f s, %s)%s\n", standard_input_name(job->photo), job->output, laps->total,
               written_words(written, amount), lit_by(r, maps, lit));
    if (!r->quiet) warnings_print(&doubts, "estimate", standard_input_name(job->photo), TOLD);
    return s;
}

/* Returns the seconds since *clock, which is set to now. */
static double lap(double *clock)
{
    double now = clock_seconds(), passed = now - *clock;
    *clock = now;
    return passed;
}

static void plan(const request *r, double pixels)
{
    stage_cost stages[STAGE_BAR_MOST];
    size_t count = expect_estimate(pixels, stages, 0);
    stages[count++] = (stage_cost){"writing", expect_maps_written(pixels, r->mesh || r->meshes.count > 0)};
    if (r->html) stages[count - 1].cost += page_cost(pixels);
    stage_bar_plan(r->bar, stages, count);
}

/* Processes a photograph in memory, which is empty afterwards, to files. */
static status process_photo(const request *r, const photo_job *job, photo_taken *taken, lap_times *laps)
{
    double began = clock_seconds(), clock = began;
    const bool last = job == &r->photos->at[r->photos->count - 1];
    merlin_maps maps = {0};
    staged_files written = {0};
    const char *const inputs[STAGING_MOST_INPUTS] = {job->photo, job->mask};
    const estimate_write more = {r, job->photo, job->output, inputs, standard_input_is(job->photo) ? NULL : job};
    merlin_params params = r->params;
    params.progress = r->watch->tell;
    params.progress_context = r->watch->context;
    params.last = last;
    plan(r, (double)taken->photo.width * taken->photo.height);
    status s = photo_estimate(r->model, taken, &params, &maps);
    if (s != OK) s = fail_in(s, "%s", job->photo);
    lap(&clock);
    if (s == OK) s = estimate_write_files(&more, &maps, last, &written);
    laps->write = lap(&clock);
    laps->total = laps->start + laps->model + laps->compile + laps->read + laps->mask + clock - began;
    if (s == OK) s = announce(r, job, &maps, &written, laps);
    merlin_files_free(&written);
    merlin_maps_free(&maps);
    return s;
}

static status estimate_one(const request *r, const photo_job *job)
{
    photo_taken taken;
    lap_times laps = {0};
    status s = photo_take(job, &taken);
    laps.read = taken.read_seconds;
    laps.mask = taken.object.seconds;
    return s == OK ? process_photo(r, job, &taken, &laps) : s;
}

/* Reads the first photograph, and finds its object, while the weights are read and the network is prepared. */
static status estimate_first(request *r, const photo_job *job, bool *ready, bool *broken)
{
    photo_taken taken;
    lap_times laps = {.start = (double)clock() / CLOCKS_PER_SEC};
    double now = clock_seconds();
    photo_ahead first;
    photo_begin(&first, job);
    status opened = photo_open_models(r->weights, r->flash_weights, &r->model), s = OK;
    laps.model = lap(&now);
    if (opened == OK) opened = merlin_model_prepare(r->model, &r->params);
    *ready = opened == OK;
    *broken = !*ready;
    laps.compile = lap(&now);
    char words[1024];
    if (opened != OK) snprintf(words, sizeof words, "%s", status_message());
    s = photo_finish(&first, &taken);
    laps.read = lap(&now);
    taken.object.seconds = 0; /* they ran in parallel */
    if (opened == OK) return s == OK ? process_photo(r, job, &taken, &laps) : s;
    photo_taken_free(&taken);
    return fail(opened, "%s", words);
}

/* Sets photograph i's share of the whole; its stages follow when its size is known. */
static void begin_photo(const request *r, const photo_list *photos, size_t i, double *done, double all)
{
    double cost = expect_photo(photos->at[i].photo);
    stage_bar_span(r->bar, *done / all, fmin((*done + cost) / all, 1), i + 1, photos->count);
    plan(r, 0);
    watch_tell(r->watch, "reading", 0);
    *done += cost;
}

/* Continues after a photograph that fails, but not without weights. */
static int estimate_all(request *r, const photo_list *photos)
{
    int code = 0;
    double done = 0, all = 0;
    for (size_t i = 0; i < photos->count; i++)
        all += expect_photo(photos->at[i].photo);
    bool ready = false, broken = false;
    for (size_t i = 0; i < photos->count; i++) {
        const photo_job *job = &photos->at[i];
        begin_photo(r, photos, i, &done, all);
        status s = cli_interrupted() ? MERLIN_STOPPED : check_photo_and_mask(job->photo, job->mask);
        if (s == OK) s = check_replaced(job->output, false);
        if (s == OK) s = check_inputs_kept(job->output, job->photo, job->mask);
        if (s == OK) s = check_output(job->output);
        if (s == OK) s = ready ? estimate_one(r, job) : estimate_first(r, job, &ready, &broken);
        if (s != OK) stage_bar_hide(r->bar);
        if (s == MERLIN_STOPPED)
            return cli_fail("estimate", fail(s, "interrupted; nothing was written for %s", job->photo));
        if (s == OK) continue;
        cli_fail("estimate", s);
        if (broken) return 1;
        code = 1;
    }
    return code;
}

/* Removes photographs that have all that is asked for. */
static size_t drop_done(const request *r, photo_list *photos)
{
    const char *inside[] = {"report.json", NULL, NULL, NULL};
    size_t count = 1;
    if (r->mesh) inside[count++] = "mesh.glb";
    if (r->html) inside[count++] = PAGE_FILE;
    return photo_list_drop_done(
        photos,
        &(photo_wanted){inside, r->meshes.at, (size_t)r->meshes.count, {&r->params, r->weights, r->flash_weights}});
}

/* Removes photographs of other shares, and those that are done. */
static void skip_photos(const request *r, photo_list *photos)
{
    if (r->share.of) photo_list_share(photos, &r->share);
    size_t done = r->resume ? drop_done(r, photos) : 0;
    if (done && !r->quiet)
        fprintf(messages(), "merlin estimate: %zu of %zu photographs have their maps\n", done, done + photos->count);
}

int cmd_estimate(int argc, char **argv)
{
    request r = {.params = merlin_params_default(), .smooth = -1};
    r.params.stop = cli_interrupted;
    status s = parse(&argc, &argv, &r);
    if (s != OK) return cli_refuse("estimate", s);
    if (r.help) return fputs(help, stdout) < 0;
    cli_catch_interrupts();
    if (r.sequence) return estimate_sequence(&r, argc, argv);
    photo_list photos;
    s = photo_list_make(argv, argc, r.mask, r.output, &photos);
    if (s != OK) return cli_fail("estimate", s);
    if (!r.quiet) photo_list_tell(&photos, "estimate");
    s = photo_find_models(r.model_name, &r.weights, &r.flash_weights);
    if (s == OK) skip_photos(&r, &photos);
    bool told = false;
    r.photos = &photos;
    r.told = &told;
    if (photo_hint_given(&r.params.hint) && photos.count) photo_use_hint(&photos.at[0], &r.params.hint);
    stage_bar bar;
    stage_bar_begin(&bar, r.quiet);
    const watch shown = stage_bar_watch(&bar);
    r.bar = &bar;
    r.watch = &shown;
    int code = s == OK ? estimate_all(&r, &photos) : cli_fail("estimate", s);
    stage_bar_end(&bar);
    merlin_model_close(r.model);
    free(r.weights);
    free(r.flash_weights);
    photo_list_free(&photos);
    return code;
}
