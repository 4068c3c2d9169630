/* SPDX-License-Identifier: MIT */
/* merlin-lab render: training data. */
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/json/json_put.h"
#include "base/text/report.h"
#include "command/check_files.h"
#include "command/cli.h"
#include "command/json_line.h"
#include "command/options.h"
#include "lab/cli/lab_commands.h"
#include "lab/render/generate.h"

static const char help[] =
    "usage: merlin-lab render --count N -o DIR [options]\n"
    "Renders training samples: objects with their maps, under a flash at the camera (direct and indirect light apart)\n"
    "and under an environment. A run that was interrupted is continued by the same command.\n"
    "\n"
    "  --count N          how many samples (required)\n"
    "  -o, --output D     folder for the samples, 000000.exr and on, and render.txt with the options (required)\n"
    "  --seed S           seed of the data set (default 1)\n"
    "  --first I          index of the first sample (default 0)\n"
    "  --size P           pixels on a side (default 128)\n"
    "  --fov DEG[-DEG]    horizontal field of view (default 60); two: every sample has one between them\n"
    "  --off-axis DEG     pictures are cut out of larger ones, up to so far beside the lens's axis\n"
    "  --mesh F           this OBJ, PLY or glTF object, with procedural materials, instead of procedural shapes\n"
    "  --mesh-dir D       meshes of this folder, deformed, for a share of the objects\n"
    "  --mesh-share S     how large that share is (default 0.5)\n"
    "  --env-dir D        environment maps from this folder instead of procedural ones\n"
    "  --material-dir D   photographed materials (albedo, normal, roughness maps that tile) on most objects\n"
    "  --no-env           no environment image\n"
    "  --targets K        also K images under random lights in front, with cast shadows\n"
    "  --leds K           also K images under LEDs with random lobes about the camera, stored after the targets\n"
    "  --lamps K          also K images under random lamps, near and far, in front and beside, points and discs\n"
    "  --lamp-angles A,.. these lamps instead: points as far as the camera, so many degrees from the line to it\n"
    "  --bounces          also keep bounce 2 and bounce 3 apart\n"
    "  --spp N            camera rays a pixel: 1, 4, 16, 36 or 64 (default 16)\n"
    "  --paths N          indirect paths a pixel (default 8); environment light takes five for every eight\n"
    "  -t, --threads N    how many threads work (default: one a processor)\n"
    "  -q, --quiet        no other output than errors\n"
    "  --json             a report as JSON on standard output\n"
    "  -h, --help         this text\n";

typedef struct request {
    render_options options;
    bool no_environment, json, help;
} request;

static status take_strata(const char *text, void *to)
{
    long value = 0;
    status s = cli_int("--spp", text, 1, VISIBILITY_MAX_STRATA * VISIBILITY_MAX_STRATA, &value);
    if (s != OK) return s;
    int strata = (int)lround(sqrt((double)value));
    if (strata * strata != value || (value > 1 && strata % 2))
        return fail(MERLIN_WRONG_USE, "--spp must be 1, 4, 16, 36 or 64, not %s", text);
    *(int *)to = strata;
    return OK;
}

/* Parses one angle, or two with a hyphen between. */
static status take_fov(const char *text, void *to)
{
    render_options *o = to;
    char low[32];
    const char *hyphen = strchr(text, '-');
    size_t length = hyphen ? (size_t)(hyphen - text) : strlen(text);
    if (length == 0 || length >= sizeof low)
        return fail(MERLIN_WRONG_USE, "--fov must be like 60 or 8-75, not %s", text);
    memcpy(low, text, length);
    low[length] = 0;
    double narrow = 0, wide = 0;
    status s = cli_float("--fov", low, 5, 120, &narrow);
    if (s == OK && hyphen) s = cli_float("--fov", hyphen + 1, narrow, 120, &wide);
    o->image.fov = (float)narrow;
    o->widest_fov = (float)wide;
    return s;
}

static status take_share(const char *text, void *to)
{
    double share = 0;
    status s = cli_float("--mesh-share", text, 0.001, 1, &share);
    *(float *)to = (float)share;
    return s;
}

/* Parses degrees separated by commas. */
static status take_angles(const char *text, void *to)
{
    image_settings *image = &((render_options *)to)->image;
    image->lamp_angles = 0;
    for (const char *at = text; at; at = strchr(at, ',') ? strchr(at, ',') + 1 : NULL) {
        char one[32];
        double angle = 0;
        snprintf(one, sizeof one, "%.*s", (int)strcspn(at, ","), at);
        if (image->lamp_angles == SAMPLE_MAX_LAMPS)
            return fail(MERLIN_WRONG_USE, "--lamp-angles: at most %d lamps", SAMPLE_MAX_LAMPS);
        status s = cli_float("--lamp-angles", one, 0, 180, &angle);
        if (s != OK) return s;
        image->lamp_angle[image->lamp_angles++] = (float)angle;
    }
    image->lamps = image->lamp_angles;
    return OK;
}

static status read_options(int *argc, char ***argv, request *r)
{
    render_options *o = &r->options;
    const cli_option options[] = {
        {"count", .count = &o->count, .low = 1, .high = 100000000},
        {"output", 'o', .folder = &o->folder},
        {"seed", .whole = &o->seed, .low = 0, .high = LONG_MAX},
        {"first", .whole = &o->first, .low = 0, .high = 1000000000},
        {"size", .integer = &o->image.size, .low = 8, .high = 4096},
        {"fov", .take = take_fov, .into = o},
        {"off-axis", .real = &o->off_axis, .low = 0, .high = 40},
        {"mesh", .text = &o->mesh},
        {"mesh-dir", .text = &o->mesh_folder},
        {"mesh-share", .take = take_share, .into = &o->mesh_share},
        {"env-dir", .text = &o->environment_folder},
        {"material-dir", .text = &o->material_folder},
        {"no-env", .flag = &r->no_environment},
        {"targets", .integer = &o->image.targets, .low = 0, .high = SAMPLE_MAX_TARGETS},
        {"leds", .integer = &o->image.leds, .low = 0, .high = SAMPLE_MAX_TARGETS},
        {"lamps", .integer = &o->image.lamps, .low = 0, .high = SAMPLE_MAX_LAMPS},
        {"lamp-angles", .take = take_angles, .into = o},
        {"bounces", .flag = &o->image.bounces},
        {"spp", .take = take_strata, .into = &o->image.strata},
        {"paths", .integer = &o->image.paths, .low = 1, .high = 4096},
        {"quiet", 'q', .flag = &o->quiet},
        {"json", .flag = &r->json},
        {"help", 'h', .flag = &r->help},
        {0},
    };
    return cli_read_options(argc, argv, options);
}

static status parse(int argc, char **argv, request *r)
{
    status s = read_options(&argc, &argv, r);
    if (s != OK || r->help) return s;
    if (argc > 0) return fail(MERLIN_WRONG_USE, "unexpected argument %s", argv[0]);
    if (r->options.count == 0) return fail(MERLIN_WRONG_USE, "--count is required");
    if (!r->options.folder) return fail(MERLIN_WRONG_USE, "an output folder is required: -o DIR");
    if (r->no_environment && r->options.environment_folder)
        return fail(MERLIN_WRONG_USE, "--env-dir and --no-env contradict each other");
    if (r->options.mesh && r->options.mesh_folder)
        return fail(MERLIN_WRONG_USE, "--mesh and --mesh-dir contradict each other");
    if (r->options.mesh_share > 0 && !r->options.mesh_folder)
        return fail(MERLIN_WRONG_USE, "--mesh-share is of the meshes in --mesh-dir D");
    r->options.environment = !r->no_environment;
    return OK;
}

static status print_json(const request *r, const render_stats *stats, double samples, double rays)
{
    warnings told = {0};
    skipped_warn(&stats->skipped_maps, &told);
    skipped_warn(&stats->skipped_materials, &told);
    skipped_warn(&stats->skipped_meshes, &told);
    cJSON *report = report_begin(&told);
    if (told.count) {
        cJSON *all = json_put_array(report, "skipped");
        skipped_json(&stats->skipped_maps, r->options.environment_folder, all);
        skipped_json(&stats->skipped_materials, r->options.material_folder, all);
        skipped_json(&stats->skipped_meshes, r->options.mesh_folder, all);
    }
    json_put_text(report, "output", r->options.folder);
    json_put_number(report, "rendered", (double)stats->rendered);
    json_put_number(report, "kept", (double)stats->kept);
    json_put_number(report, "seconds", stats->seconds);
    json_put_number(report, "samples_per_second", samples);
    json_put_number(report, "rays", (double)stats->rays);
    json_put_number(report, "rays_per_second", rays);
    status s = json_line_print(report);
    cJSON_Delete(report);
    return s;
}

static status report(const request *r, const render_stats *stats)
{
    double seconds = stats->seconds > 0 ? stats->seconds : 1e-9;
    double samples = (double)stats->rendered / seconds, rays = (double)stats->rays / seconds;
    if (r->json) return print_json(r, stats, samples, rays);
    if (!r->options.quiet)
        printf("%zu rendered, %zu kept, %.1f s: %.2f samples/s, %.2f million rays/s\n", stats->rendered, stats->kept,
               stats->seconds, samples, rays / 1e6);
    return OK;
}

/* Checks the inputs before a folder's environments are read, which takes seconds. */
static status check_inputs(const render_options *o)
{
    status s = check_named("mesh", o->mesh);
    if (s == OK) s = check_named("folder of environments", o->environment_folder);
    return s == OK ? check_named("folder of materials", o->material_folder) : s;
}

int cmd_render(int argc, char **argv)
{
    request r = {.options = render_options_default()};
    r.options.seed = 1;
    r.options.interrupted = cli_interrupted;
    if (parse(argc, argv, &r) != OK) return cli_usage("render", "%s", status_message());
    if (r.help) return fputs(help, stdout) < 0;
    cli_catch_interrupts();
    render_stats stats = {0};
    status s = check_inputs(&r.options);
    if (s == OK) s = render_samples(&r.options, &stats);
    if (s == OK && !r.options.quiet) {
        skipped_print(&stats.skipped_maps, "render", r.options.environment_folder);
        skipped_print(&stats.skipped_materials, "render", r.options.material_folder);
        skipped_print(&stats.skipped_meshes, "render", r.options.mesh_folder);
    }
    if (s == OK) s = report(&r, &stats);
    render_stats_free(&stats);
    return s == OK ? 0 : cli_fail("render", s);
}
