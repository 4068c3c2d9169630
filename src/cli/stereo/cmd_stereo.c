/* SPDX-License-Identifier: MIT */
/* merlin stereo: surfaces from many lights, and from one photograph. */
#include <cjson/cJSON.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/json/json_put.h"
#include "base/progress.h"
#include "cli/check_replaced.h"
#include "cli/commands.h"
#include "cli/left_files.h"
#include "cli/page.h"
#include "cli/stage_bar.h"
#include "cli/stereo/stereo_commands.h"
#include "cli/stereo/stereo_output.h"
#include "cli/stereo/stereo_universal.h"
#include "cli/written.h"
#include "command/check_files.h"
#include "command/cli.h"
#include "command/json_line.h"
#include "command/options.h"
#include "command/photo_ahead.h"
#include "command/photo_hint.h"
#include "command/photos.h"
#include "command/standard_input.h"
#include "merlin/frames.h"
#include "merlin/surface.h"

static const char help[] =
    "usage: merlin stereo DIR|VIDEO|PICTURE PICTURE... [options]\n"
    "       merlin stereo PHOTO|MAPS [options]\n"
    "       merlin stereo calibrate --sphere chrome|matte DIR [options]\n\n"
    "Normals, albedo and the surface of an object by photometric stereo: from a folder of pictures, each under one\n"
    "light (lights.txt, an .lp file, the LUCES or the DiLiGenT layout; without such a list the model sees the\n"
    "pictures together, and all is written that merlin estimate writes), likewise from pictures named one by one or\n"
    "a video under a lamp that moves, of which the frames are taken whose light differs most; or from one\n"
    "photograph, relit by the model under 50 lights. MAPS is a folder made by merlin estimate, or its maps.exr: the\n"
    "photograph is not estimated again. A PHOTO may be -, standard input. calibrate finds light directions from\n"
    "pictures of a ball.\n\n"
    "      --lights FILE    x y z a line, in the order of the pictures' names (9.png before 10.png), or .lp, likewise\n"
    "                       where it names none of the pictures, as a dome's (default: found in DIR); equally strong,\n"
    "                       unless DIR, or what FILE is in, has a light_intensities.txt (or .csv) with one or three\n"
    "                       numbers a line\n"
    "      --near           the lights are positions, not directions: with the camera at 0,0,0 looking along -z, or "
    "in\n"
    "                       an .lp file about the object, z toward the camera, whose places are heeded\n"
    "                       without --near, too, where they explain the pictures better than directions\n"
    "      --fov DEG        the camera's horizontal field of view (default: by EXIF of universal, by EXIF or 60\n"
    "                       with --near, else as seen from afar)\n"
    "      --distance D     from the camera to the object, on average, in the unit of the lights' positions (default:\n"
    "                       with --near as the lights tell, else 1); depth is in it. Wants --near or --fov\n"
    "      --method NAME    for known directions ls, robust (gloss and cast shadows) or semi (unknown strengths),\n"
    "                       near for positions, nfps the same by a network; without lights universal (by a model of\n"
    "                       any light; from seven pictures on the lights are found) or uncalibrated (without a "
    "model);\n"
    "                       auto (default): near with --near, robust with lights, else universal; of one photograph\n"
    "                       near (default) or uncalibrated\n"
    "      --mask FILE      white on the object (default: mask.png, NAME.mask.png, NAME_mask.png or the like in DIR, "
    "of\n"
    "                       any picture's kind, else what is brighter than a dark background)\n"
    "      --ambient FILE   a picture without the lights, to subtract (default: ambient.* in DIR)\n"
    "      --linear         8-bit pictures hold linear values, not sRGB\n"
    "      --frames N       of a video at most so many frames, 1 to 64 (default: 16)\n"
    "      --integrate HOW  ls (default) or edges: depth may jump\n"
    "      --mesh FILE      .ply, .obj, .glb or .usda; may be given again (default: mesh.ply, mesh.obj, mesh.glb in "
    "the "
    "output)\n"
    "      --html           write viewer.html, too: a page in which a browser lights the surface (merlin view)\n"
    "  -o, --output DIR     where to (default: stereo inside DIR, or inside the photograph's name + .merlin)\n"
    "      --model W, --size N, --views N, --exposure EV, --point X,Y, --box X,Y,W,H\n"
    "                       for a PHOTO, as in merlin estimate, and for pictures without lights, except --exposure;\n"
    "                       --model also for MAPS, and for --method nfps and near\n"
    "      --json           the report on standard output\n"
    "  -t, --threads N      how many threads work (default: one a processor)\n"
    "  -q, --quiet          no other output than errors\n"
    "  -h, --help           this text\n\n"
    "Writes maps.exr, normal.png, albedo.png, depth.png, mask.png, error.png, overview.png, report.json,\n"
    "confidence.png (dark where normals depend on single pictures; not with ls) and meshes.\n"
    "Depth and meshes are in the unit of the lights' positions with --near; from afar they are in pixels (.glb and\n"
    ".usda have a scale by which the picture is one unit large).\n";

typedef struct request {
    const char *input, *output, *weights;
    const char *const *pictures; /* count of them, named one by one */
    int count;
    merlin_capture_files capture;
    merlin_stereo_params solve;
    merlin_params params;
    stereo_files files;
    bool maps, video; /* whether input is a folder of merlin estimate, a video */
    bool near, linear, json, quiet, help;
    bool universal; /* no lights are known, and a network sees the pictures together */
} request;

/* ---- options ---- */

static status take_method(const char *name, void *into)
{
    request *r = into;
    r->universal = strcmp(name, "universal") == 0;
    if (r->universal) return OK;
    for (int m = MERLIN_STEREO_AUTO; m <= MERLIN_STEREO_NFPS; m++)
        if (strcmp(name, merlin_stereo_method_name((merlin_stereo_method)m)) == 0) {
            r->solve.method = (merlin_stereo_method)m;
            return OK;
        }
    return fail(MERLIN_WRONG_USE,
                "--method wants ls, robust, near, nfps, semi, universal, uncalibrated or auto, not \"%s\"", name);
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
    merlin_stereo_params *params = into;
    params->integrate = 1;
    params->keep_edges = strcmp(name, "edges") == 0;
    if (!params->keep_edges && strcmp(name, "ls") != 0)
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
    return (file_is_folder(r->input) && !r->maps) || r->video || r->count > 1;
}

static status check_maps(const request *r)
{
    int captured = 0;
    status s = photo_check_maps(r->input, r->capture.mask, &r->params);
    if (s == OK) s = merlin_maps_look(r->input, &captured);
    if (s != OK || !captured) return s;
    return fail(MERLIN_BAD_INPUT, "%s holds a captured surface, not the maps of one photograph to relight", r->input);
}

/* Refuses options of the network where none sees the pictures. */
static status check_no_network(const request *r)
{
    const bool sees_lights = r->solve.method == MERLIN_STEREO_NFPS || r->solve.method == MERLIN_STEREO_NEAR;
    if ((!r->weights || sees_lights) && !photo_params_given(&r->params)) return OK;
    return fail(MERLIN_WRONG_USE,
                "--model, --size, --views, --exposure, --point and --box are for one photograph, or pictures without a "
                "list of lights");
}

static status check(request *r)
{
    const merlin_capture_files *o = &r->capture;
    if (r->universal || r->solve.method == MERLIN_STEREO_UNCALIBRATED) r->capture.unknown_lights = 1;
    r->capture.lights_optional = r->solve.method == MERLIN_STEREO_AUTO;
    r->video = r->count == 1 && merlin_frames_are(r->input) == 1;
    if (o->frames && !r->video) return fail(MERLIN_WRONG_USE, "--frames is for a video, and %s is none", r->input);
    if ((o->lights || o->near_lights) && o->unknown_lights)
        return fail(MERLIN_WRONG_USE, "--method %s takes no --lights and no --near: it finds both kinds of lights",
                    r->universal ? "universal" : "uncalibrated");
    status s = o->lights || r->count > 1 ? OK : look_for_maps(r->input, &r->maps);
    if (s != OK) return s;
    bool is_one_photo = file_exists(r->input) && !is_capture(r);
    if (is_one_photo &&
        (o->lights || o->near_lights || o->field_of_view > 0 || o->distance > 0 || o->ambient || o->linear))
        return fail(MERLIN_WRONG_USE,
                    "--lights, --near, --fov, --distance, --ambient and --linear are for a folder of pictures");
    bool is_distant = r->solve.method == MERLIN_STEREO_LS || r->solve.method == MERLIN_STEREO_ROBUST ||
                      r->solve.method == MERLIN_STEREO_SEMI;
    if (is_one_photo && r->universal) return fail(MERLIN_WRONG_USE, "--method universal is for a folder of pictures");
    if (is_one_photo && is_distant)
        return fail(MERLIN_WRONG_USE,
                    "--method %s is for distant lights, and one photograph is relit by near ones: use near",
                    merlin_stereo_method_name(r->solve.method));
    if (is_one_photo && r->solve.method == MERLIN_STEREO_NFPS)
        return fail(MERLIN_WRONG_USE, "--method nfps is for a folder of pictures under known lights");
    if (r->maps) return check_maps(r);
    const bool may_lack_lights = r->solve.method == MERLIN_STEREO_AUTO && !o->lights && !o->near_lights;
    if (is_capture(r) && !may_lack_lights) s = check_no_network(r);
    if (s == OK && is_capture(r) && !r->params.auto_exposure)
        s = fail(MERLIN_WRONG_USE, "--exposure is for one photograph, not for a folder");
    if (s != OK) return s;
    return photo_check_hint(&r->params.hint, o->mask, false);
}

/* Takes a folder, a video or a photograph, or several pictures of one object. */
static status take_inputs(request *r, int count, char **names)
{
    r->count = count;
    r->pictures = (const char *const *)names;
    if (count == 1) return photo_take_input(names, r->output, &r->input);
    r->input = names[0];
    for (int i = 0; i < count; i++) {
        const char *kind = file_is_folder(names[i])           ? "a folder"
                           : merlin_frames_are(names[i]) == 1 ? "a video"
                           : strcmp(names[i], "-") == 0       ? "standard input"
                                                              : NULL;
        if (kind) return fail(MERLIN_WRONG_USE, "%s is %s, which comes alone", names[i], kind);
        if (!file_exists(names[i])) return fail(MERLIN_BAD_INPUT, "there is no picture %s", names[i]);
    }
    return OK;
}

static status parse(int *argc, char ***argv, request *r)
{
    const cli_option options[] = {
        {"lights", .text = &r->capture.lights},
        {"near", .flag = &r->near},
        {"fov", .real = &r->capture.field_of_view, .low = 1, .high = 170},
        {"distance", .take = take_distance, .into = &r->capture.distance},
        {"method", .take = take_method, .into = r},
        {"mask", .text = &r->capture.mask},
        {"point", .take = photo_take_point, .into = &r->params.hint, .many = true},
        {"box", .take = photo_take_box, .into = &r->params.hint},
        {"ambient", .text = &r->capture.ambient},
        {"linear", .flag = &r->linear},
        {"frames", .integer = &r->capture.frames, .low = 1, .high = 64},
        {"integrate", .take = take_integration, .into = &r->solve},
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
    r->capture.near_lights = r->near;
    r->capture.linear = r->linear;
    s = take_inputs(r, *argc, *argv);
    return s == OK ? check(r) : s;
}

/* ---- the work ---- */

static status from_photo(const request *r, merlin_surface *out)
{
    char *weights = NULL, *flash = NULL;
    merlin_model *model = NULL;
    merlin_maps maps = {0};
    r->solve.progress(r->solve.progress_context, "relighting", 0);
    status s = r->maps ? merlin_maps_read(r->input, &maps) : OK;
    if (s == OK) s = photo_find_models_of(&maps, r->weights, &weights, &flash);
    if (s == OK) s = photo_open_models(weights, flash, &model);
    if (s == OK && !r->maps) s = photo_maps(model, r->input, r->capture.mask, &r->params, &maps);
    if (s == OK) s = merlin_stereo_from_maps(model, &maps, &r->solve, out);
    merlin_maps_free(&maps);
    merlin_model_close(model);
    free(weights);
    free(flash);
    return s;
}

static status from_capture(const request *r, const merlin_capture *capture, merlin_surface *out)
{
    const merlin_stereo_method m = r->solve.method;
    merlin_near_network *network = NULL;
    status s = OK;
    if (m == MERLIN_STEREO_AUTO || m == MERLIN_STEREO_NEAR || m == MERLIN_STEREO_NFPS)
        s = photo_open_near(r->weights, m == MERLIN_STEREO_NFPS, &network);
    if (s == OK) s = merlin_stereo_by_network(network, capture, &r->solve, out);
    merlin_near_network_close(network);
    return s;
}

static status print_json(const request *r, const merlin_surface *surface, const char *output,
                         const staged_files *written)
{
    char *text;
    status s = merlin_surface_report(surface, standard_input_is(r->input) ? "-" : r->input, &text);
    if (s != OK) return s;
    cJSON *report = cJSON_Parse(text);
    json_line_files(report, output, written);
    s = json_line_print(report);
    cJSON_Delete(report);
    free(text);
    return s;
}

static status announce(const request *r, const char *output, const merlin_surface *surface, const staged_files *written,
                       double seconds)
{
    char amount[WRITTEN_WORDS];
    status s = OK;
    if (r->json)
        s = print_json(r, surface, output, written);
    else if (!r->quiet)
        printf("%s: %s (%.2f s, %s)\n", standard_input_name(r->input), output, seconds, written_words(written, amount));
    enum { TOLD = 3 };
    if (!r->quiet) warnings_print(&surface->warnings, "stereo", standard_input_name(r->input), TOLD);
    if (!r->quiet) skipped_print(&surface->skipped, "stereo", r->input);
    return s;
}

/* Plans the progress by the costs of the stages, in seconds for twenty pictures of 2048×2048 on two processors; ratios
 * are about the same for pictures of any number and size. With one photograph random subsets are solved. */
static void plan(const request *r, stage_bar *bar)
{
    static const double solving[] = {
        [MERLIN_STEREO_LS] = 0.2,   [MERLIN_STEREO_ROBUST] = 4.4,        [MERLIN_STEREO_NEAR] = 9,
        [MERLIN_STEREO_SEMI] = 4.5, [MERLIN_STEREO_UNCALIBRATED] = 11.5, [MERLIN_STEREO_NFPS] = 8};
    bool edges = r->solve.keep_edges;
    merlin_stereo_method method = r->solve.method;
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

/* Writes the surface and reports it. */
static status write_surface(const request *r, const stereo_files *files, stage_bar *bar, const watch *shown,
                            merlin_surface *surface, double began)
{
    staged_files written = {0};
    surface->seconds.total = clock_seconds() - began;
    watch_tell(shown, "writing", 0);
    status s = cli_interrupted() ? fail(MERLIN_STOPPED, "stopped") : stereo_write(files, surface, &written);
    stage_bar_hide(bar);
    if (s == OK) left_files_warn(files->folder, &written, &surface->warnings);
    if (s == OK) s = announce(r, files->folder, surface, &written, clock_seconds() - began);
    merlin_files_free(&written);
    return s;
}

/* Refuses what has no meaning for maps, whose depth is that of a surface about 1 away. */
static status check_together(const request *r)
{
    const char *given = r->solve.integrate ? "--integrate" : r->capture.distance > 0 ? "--distance" : NULL;
    if (!given) return OK;
    return fail(
        MERLIN_WRONG_USE,
        "%s is for pictures with a list of lights, or by --method uncalibrated: maps of others are of an object "
        "about 1 away",
        given);
}

/* Makes maps of pictures whose lights nobody knows, and frees the capture. */
static status see_together(const request *r, merlin_capture *capture, const stereo_files *files, stage_bar *bar,
                           const watch *shown, double began)
{
    universal_request u = {.input = r->input,
                           .weights = r->weights,
                           .files = files,
                           .params = r->params,
                           .json = r->json,
                           .quiet = r->quiet,
                           .bar = bar,
                           .watch = shown,
                           .began = began};
    u.params.fov = r->capture.field_of_view;
    u.params.progress = shown->tell;
    u.params.progress_context = shown->context;
    u.params.stop = shown->stop;
    status s = check_together(r);
    if (s == OK) return stereo_universal(&u, capture);
    merlin_capture_free(capture);
    return s;
}

static bool sees_together(const request *r, const merlin_capture *capture)
{
    const bool unknown = capture && merlin_capture_lighting(capture) == MERLIN_UNKNOWN_LIGHTS;
    return r->universal || (unknown && r->solve.method == MERLIN_STEREO_AUTO);
}

static status read_capture(const request *r, merlin_capture **out)
{
    return r->count > 1 ? merlin_capture_read_pictures(r->pictures, (size_t)r->count, &r->capture, out)
                        : merlin_capture_read(r->input, &r->capture, out);
}

static status solve_and_write(request *r, const stereo_files *files, stage_bar *bar, const watch *shown)
{
    const double began = clock_seconds();
    merlin_capture *capture = NULL;
    merlin_surface surface = {0};
    status s = is_capture(r) ? read_capture(r, &capture) : OK;
    if (s == OK && sees_together(r, capture)) {
        s = see_together(r, capture, files, bar, shown, began);
    } else if (s == OK) {
        s = capture ? check_no_network(r) : OK;
        if (s == OK) s = capture ? from_capture(r, capture, &surface) : from_photo(r, &surface);
        merlin_capture_free(capture);
        if (s == OK) s = write_surface(r, files, bar, shown, &surface, began);
    }
    merlin_surface_free(&surface);
    return s;
}

static status work(request *r, const char *output)
{
    stage_bar bar;
    stage_bar_begin(&bar, r->quiet);
    plan(r, &bar);
    const watch shown = stage_bar_watch(&bar);
    r->capture.progress = r->solve.progress = shown.tell;
    r->capture.progress_context = r->solve.progress_context = shown.context;
    r->capture.stop = r->solve.stop = shown.stop;
    stereo_files files = r->files;
    files.folder = output;
    files.input = r->input;
    files.inputs =
        (const char *const[STAGING_MOST_INPUTS]){r->input, r->capture.mask, r->capture.ambient, r->capture.lights};
    files.stop = cli_interrupted;
    status s = solve_and_write(r, &files, &bar, &shown);
    stage_bar_end(&bar);
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
    status s = output ? OK : fail(MERLIN_NO_MEMORY, "no memory for a file name");
    if (s == OK) s = check_photo_and_mask(r->input, r->capture.mask);
    if (s == OK) s = check_replaced(output, r->files.mesh.count == 0);
    if (s == OK) s = check_inputs_kept(output, r->input, r->capture.mask);
    if (s == OK) s = check_output(output);
    if (s == OK) s = work(r, output);
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
