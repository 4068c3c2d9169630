/* SPDX-License-Identifier: MIT */
/* merlin stereo: surfaces from many lights, and from one photograph. */
#include <cJSON.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/json/json_put.h"
#include "base/progress.h"
#include "base/text/report.h"
#include "cli/check_replaced.h"
#include "cli/commands.h"
#include "cli/page.h"
#include "cli/stage_bar.h"
#include "cli/stereo/stereo_commands.h"
#include "cli/stereo/stereo_folder.h"
#include "cli/stereo/stereo_photo.h"
#include "cli/written.h"
#include "command/check_files.h"
#include "command/cli.h"
#include "command/json_line.h"
#include "command/options.h"
#include "command/photo_hint.h"
#include "command/photos.h"
#include "command/standard_input.h"
#include "estimate/surface/crop.h"
#include "stereo/fit/albedo_scale.h"

static const char help[] =
    "usage: merlin stereo DIR [options]\n"
    "       merlin stereo PHOTO|MAPS [options]\n"
    "       merlin stereo calibrate --sphere chrome|matte DIR [options]\n\n"
    "Normals, albedo and the surface of an object by photometric stereo: from a folder of pictures, each under one\n"
    "light (lights.txt, an .lp file, the LUCES or the DiLiGenT layout), or from one photograph, relit by the model\n"
    "under 50 lights. MAPS is a folder made by merlin estimate, or its maps.exr: the photograph is not estimated\n"
    "again. A PHOTO may be -, standard input. calibrate finds light directions from pictures of a ball.\n\n"
    "      --lights FILE    x y z a line, in the order of the pictures' names (9.png before 10.png), or .lp, likewise\n"
    "                       where it names none of the pictures, as a dome's (default: found in DIR); equally strong,\n"
    "                       unless DIR, or what FILE is in, has a light_intensities.txt (or .csv) with one or three\n"
    "                       numbers a line\n"
    "      --near           the lights are positions, not directions: with the camera at 0,0,0 looking along -z, or "
    "in\n"
    "                       an .lp file about the object, z toward the camera, whose places are heeded\n"
    "                       without --near, too, where they explain the pictures better than directions\n"
    "      --fov DEG        the camera's horizontal field of view (default: 60 with --near, else as seen from afar)\n"
    "      --distance D     from the camera to the object, on average, in the unit of the lights' positions (default:\n"
    "                       with --near as the lights tell, else 1); depth is in it. Wants --near or --fov\n"
    "      --method NAME    for known directions ls, robust (gloss and cast shadows) or semi (unknown strengths),\n"
    "                       near for positions, uncalibrated without lights; auto (default): near with --near,\n"
    "                       else robust; of one photograph near (default) or uncalibrated\n"
    "      --mask FILE      white on the object (default: mask.png, NAME.mask.png, NAME_mask.png or the like in DIR, "
    "of\n"
    "                       any picture's kind, else what is brighter than a dark background)\n"
    "      --ambient FILE   a picture without the lights, to subtract (default: ambient.* in DIR)\n"
    "      --linear         8-bit pictures hold linear values, not sRGB\n"
    "      --integrate HOW  ls (default) or edges: depth may jump\n"
    "      --mesh FILE      .ply, .obj or .glb; may be given again (default: mesh.ply, mesh.obj, mesh.glb in the "
    "output)\n"
    "      --html           write viewer.html, too: a page in which a browser lights the surface (merlin view)\n"
    "  -o, --output DIR     where to (default: stereo inside DIR, or inside the photograph's name + .merlin)\n"
    "      --model W, --size N, --views N, --exposure EV, --point X,Y, --box X,Y,W,H\n"
    "                       for a PHOTO, as in merlin estimate; --model also for MAPS\n"
    "      --json           the report on standard output\n"
    "  -t, --threads N      how many threads work (default: one a processor)\n"
    "  -q, --quiet          no other output than errors\n"
    "  -h, --help           this text\n\n"
    "Writes maps.exr, normal.png, albedo.png, depth.png, mask.png, error.png, overview.png, report.json and meshes.\n"
    "Depth and meshes are in the unit of the lights' positions with --near; from afar they are in pixels (mesh.glb is\n"
    "scaled to a picture one unit large).\n";

typedef struct request {
    const char *input, *output, *weights;
    stereo_folder folder;
    merlin_params params;
    stereo_files files;
    bool maps; /* whether input is a folder of merlin estimate */
    bool near, linear, json, quiet, help;
} request;

/* ---- options ---- */

static status take_method(const char *name, void *into)
{
    merlin_stereo_method *method = into;
    int m = pst_method_from_name(name);
    if (m < 0)
        return fail(MERLIN_WRONG_USE, "--method wants ls, robust, near, semi, uncalibrated or auto, not \"%s\"", name);
    *method = (merlin_stereo_method)m;
    return OK;
}

static status take_distance(const char *text, void *into)
{
    double distance;
    status s = cli_float("--distance", text, 0, 1e9, &distance);
    if (s == OK && !(distance > 0)) s = fail(MERLIN_WRONG_USE, "--distance wants a number above 0, not \"%s\"", text);
    if (s == OK) *(float *)into = (float)distance;
    return s;
}

static status take_integration(const char *name, void *into)
{
    stereo_folder *f = into;
    f->params.integrate = 1;
    f->params.keep_edges = strcmp(name, "edges") == 0;
    if (!f->params.keep_edges && strcmp(name, "ls") != 0)
        return fail(MERLIN_WRONG_USE, "--integrate wants ls or edges, not \"%s\"", name);
    return OK;
}

/* Looks for maps in a folder without lights; with lights relight --dome may have written its pictures there, too. */
static status look_for_maps(const char *folder, bool *alone)
{
    static const char *const lights[] = {".txt", ".lp", NULL};
    char **names = NULL;
    size_t count = 0;
    *alone = file_is_in(folder, "maps.exr");
    if (!*alone) return OK;
    status s = file_list(folder, lights, &names, &count);
    *alone = s == OK && count == 0;
    file_list_free(names, count);
    return s == MERLIN_NO_MEMORY ? s : OK;
}

static bool is_capture(const request *r)
{
    return file_is_folder(r->input) && !r->maps;
}

static status check_maps(const request *r)
{
    int captured = 0;
    status s = photo_check_maps(r->input, r->folder.files.mask, &r->params);
    if (s == OK) s = merlin_maps_look(r->input, &captured);
    if (s != OK || !captured) return s;
    return fail(MERLIN_BAD_INPUT, "%s holds a captured surface, not the maps of one photograph to relight", r->input);
}

static status check(request *r)
{
    const merlin_capture_files *o = &r->folder.files;
    if (r->folder.params.method == MERLIN_STEREO_UNCALIBRATED) r->folder.files.unknown_lights = 1;
    if ((o->lights || o->near_lights) && o->unknown_lights)
        return fail(MERLIN_WRONG_USE,
                    "--method uncalibrated takes no --lights and no --near: it finds both kinds of lights");
    status s = o->lights ? OK : look_for_maps(r->input, &r->maps);
    if (s != OK) return s;
    bool is_one_photo = file_exists(r->input) && !is_capture(r);
    if (is_one_photo &&
        (o->lights || o->near_lights || o->field_of_view > 0 || o->distance > 0 || o->ambient || o->linear))
        return fail(MERLIN_WRONG_USE,
                    "--lights, --near, --fov, --distance, --ambient and --linear are for a folder of pictures");
    bool is_distant = r->folder.params.method == MERLIN_STEREO_LS || r->folder.params.method == MERLIN_STEREO_ROBUST ||
                      r->folder.params.method == MERLIN_STEREO_SEMI;
    if (is_one_photo && is_distant)
        return fail(MERLIN_WRONG_USE,
                    "--method %s is for distant lights, and one photograph is relit by near ones: use near",
                    pst_method_name(r->folder.params.method));
    if (r->maps) return check_maps(r);
    if (is_capture(r) && (r->weights || photo_params_given(&r->params)))
        return fail(MERLIN_WRONG_USE,
                    "--model, --size, --views, --exposure, --point and --box are for one photograph, not for a folder");
    return photo_check_hint(&r->params.hint, o->mask, false);
}

static status parse(int *argc, char ***argv, request *r)
{
    const cli_option options[] = {
        {"lights", .text = &r->folder.files.lights},
        {"near", .flag = &r->near},
        {"fov", .real = &r->folder.files.field_of_view, .low = 1, .high = 170},
        {"distance", .take = take_distance, .into = &r->folder.files.distance},
        {"method", .take = take_method, .into = &r->folder.params.method},
        {"mask", .text = &r->folder.files.mask},
        {"point", .take = photo_take_point, .into = &r->params.hint, .many = true},
        {"box", .take = photo_take_box, .into = &r->params.hint},
        {"ambient", .text = &r->folder.files.ambient},
        {"linear", .flag = &r->linear},
        {"integrate", .take = take_integration, .into = &r->folder},
        {"mesh", .take = mesh_take_name, .into = &r->files.mesh, .many = true},
        {"html", .flag = &r->files.page},
        {"model", .text = &r->weights},
        {"size", .take = photo_take_size, .into = &r->params},
        {"views", .integer = &r->params.views, .low = 1, .high = 8},
        {"exposure", .take = photo_take_exposure, .into = &r->params},
        {"output", 'o', .folder = &r->output},
        {"json", .flag = &r->json},
        {"quiet", 'q', .flag = &r->quiet},
        {"help", 'h', .flag = &r->help},
        {0},
    };
    status s = cli_read_options(argc, argv, options);
    if (s != OK || r->help) return s;
    if (*argc == 0) return fail(MERLIN_WRONG_USE, "no folder of pictures and no photograph given");
    if (*argc > 1) return fail(MERLIN_WRONG_USE, "one folder or photograph at a time, not also %s", (*argv)[1]);
    s = standard_input_take(*argv);
    if (s != OK) return s;
    r->folder.files.near_lights = r->near;
    r->folder.files.linear = r->linear;
    r->input = r->folder.folder = photo_without_maps_name((*argv)[0]);
    if (standard_input_is(r->input) && !r->output)
        return fail(MERLIN_WRONG_USE, "a photograph from standard input has no name to go by: say where to by -o");
    return check(r);
}

/* ---- the work ---- */

static status from_photo(const request *r, const watch *shown, stereo_result *out, cJSON *report)
{
    char *weights, *flash;
    status s = photo_find_models(r->weights, &weights, &flash);
    if (s != OK) return s;
    stereo_photo p = {.photo = r->input,
                      .mask = r->folder.files.mask,
                      .weights = weights,
                      .flash = flash,
                      .params = r->params,
                      .method = r->folder.params.method,
                      .preserve_edges = r->folder.params.keep_edges,
                      .watch = shown};
    s = stereo_from_photo(&p, out, report);
    free(weights);
    free(flash);
    return s;
}

static status announce(const request *r, const char *output, const stereo_result *result, const cJSON *report,
                       const staged_files *written, double seconds)
{
    char amount[WRITTEN_WORDS];
    status s = OK;
    if (r->json)
        s = json_line_print(report);
    else if (!r->quiet)
        printf("%s: %s (%.2f s, %s)\n", standard_input_name(r->input), output, seconds, written_words(written, amount));
    enum { TOLD = 3 };
    if (!r->quiet) warnings_print(&result->doubts, "stereo", standard_input_name(r->input), TOLD);
    if (!r->quiet) skipped_print(&result->skipped, "stereo", r->input);
    return s;
}

static void put_words(cJSON *report, const char *input, const stereo_result *result)
{
    warnings all = result->doubts;
    skipped_warn(&result->skipped, &all);
    json_put_item(report, "warnings", warnings_json(&all));
    if (result->skipped.count) skipped_json(&result->skipped, input, json_put_array(report, "skipped"));
}

static void doubt_page(stereo_result *result)
{
    crop_square c;
    if (crop_around(&result->mask, &c) == OK) page_doubt(c.side, 0, &result->doubts);
}

/* Plans the progress by the costs of the stages, in seconds for twenty pictures of 2048×2048 on two processors; ratios
 * are about the same for pictures of any number and size. With one photograph the draws are solved. */
static void plan(const request *r, stage_bar *bar)
{
    static const double solving[] = {[MERLIN_STEREO_LS] = 0.2,
                                     [MERLIN_STEREO_ROBUST] = 4.4,
                                     [MERLIN_STEREO_NEAR] = 9,
                                     [MERLIN_STEREO_SEMI] = 4.5,
                                     [MERLIN_STEREO_UNCALIBRATED] = 11.5};
    bool edges = r->folder.params.keep_edges;
    merlin_stereo_method method = r->folder.params.method;
    if (method == MERLIN_STEREO_AUTO) method = r->near ? MERLIN_STEREO_NEAR : MERLIN_STEREO_ROBUST;
    const stage_cost folder[] = {{"reading", 1.4},
                                 {"solving", solving[method]},
                                 {"integrating", method == MERLIN_STEREO_NEAR ? 29
                                                 : edges                      ? 60
                                                                              : 0.9},
                                 {"writing", 1.3}};
    const stage_cost photo[] = {{"relighting", 1.3},
                                {"solving", method == MERLIN_STEREO_UNCALIBRATED ? 10 : 3},
                                {"integrating", edges ? 3 : 0.2},
                                {"writing", 0.3}};
    stage_bar_plan(bar, is_capture(r) ? folder : photo, sizeof folder / sizeof *folder);
}

static status work(request *r, const char *output, cJSON *report)
{
    double began = clock_seconds();
    stereo_result result = {0};
    staged_files written = {0};
    const merlin_capture_files *read = &r->folder.files;
    stage_bar bar;
    stage_bar_begin(&bar, r->quiet);
    plan(r, &bar);
    const watch shown = stage_bar_watch(&bar);
    r->folder.files.progress = r->folder.params.progress = shown.tell;
    r->folder.files.progress_context = r->folder.params.progress_context = shown.context;
    r->folder.files.stop = r->folder.params.stop = shown.stop;
    json_put_text(report, "input", standard_input_is(r->input) ? "-" : r->input);
    status s = is_capture(r) ? stereo_from_folder(&r->folder, &result, report) : from_photo(r, &shown, &result, report);
    float scale = 1;
    if (s == OK) s = pst_scale_albedo(&result.albedo, &result.mask, &scale);
    if (s == OK) {
        json_put_number(report, "albedo_scale", (double)scale);
        json_put_text(report, "error_map", result.error_name);
        json_put_number(report, "error_map_white", (double)result.error_white);
        json_put_text(report, "integration", r->folder.params.keep_edges ? "edges" : "ls");
        if (r->files.page) doubt_page(&result);
        put_words(report, r->input, &result);
        json_put_number(report, "seconds_total", clock_seconds() - began);
        stereo_files files = r->files;
        files.folder = output;
        files.input = standard_input_name(r->input);
        files.inputs = (const char *const[STAGING_MOST_INPUTS]){r->input, read->mask, read->ambient, read->lights};
        files.stop = cli_interrupted;
        watch_tell(&shown, "writing", 0);
        s = cli_interrupted() ? fail(MERLIN_STOPPED, "stopped") : stereo_write(&files, &result, report, &written);
        json_line_files(report, output, &written);
    }
    stage_bar_end(&bar);
    if (s == OK) s = announce(r, output, &result, report, &written, clock_seconds() - began);
    merlin_files_free(&written);
    stereo_result_free(&result);
    return s == MERLIN_STOPPED ? fail(s, "interrupted; nothing was written to %s", output) : s;
}

static status run(request *r)
{
    if (!file_exists(r->input)) return fail(MERLIN_BAD_INPUT, "there is no folder or photograph %s", r->input);
    if (r->output && file_is_same(r->input, r->output))
        return fail(MERLIN_WRONG_USE,
                    "-o %s is the folder of the pictures, where results would be taken for pictures the next "
                    "time; without it they go to stereo inside it",
                    r->output);
    char *output = photo_output_inside(r->input, "stereo", r->output);
    cJSON *report = report_begin(NULL);
    status s = output && report ? OK : fail(MERLIN_NO_MEMORY, "no memory for a report");
    if (s == OK) s = check_photo_and_mask(r->input, r->folder.files.mask);
    if (s == OK) s = check_replaced(output, r->files.mesh.count == 0);
    if (s == OK) s = check_output(output);
    if (s == OK) s = work(r, output, report);
    cJSON_Delete(report);
    free(output);
    return s;
}

int cmd_stereo(int argc, char **argv)
{
    if (argc > 1 && strcmp(argv[1], "calibrate") == 0) return stereo_calibrate(argc - 1, argv + 1);
    request r = {.params = merlin_params_default()};
    r.params.stop = cli_interrupted;
    status s = parse(&argc, &argv, &r);
    if (s != OK) return cli_refuse("stereo", s);
    if (r.help) return fputs(help, stdout) < 0;
    cli_catch_interrupts();
    s = run(&r);
    return s == OK ? 0 : cli_fail("stereo", s);
}
