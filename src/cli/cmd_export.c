/* SPDX-License-Identifier: MIT */
/* merlin export: writes maps for other programs. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/progress.h"
#include "base/text/report.h"
#include "base/warnings.h"
#include "cli/commands.h"
#include "cli/maps_folder.h"
#include "cli/written.h"
#include "command/check_files.h"
#include "command/cli.h"
#include "command/json_line.h"
#include "command/options.h"
#include "command/photos.h"
#include "merlin/export.h"

static const char help[] =
    "usage: merlin export DIR [--maps LIST] [-o DIR] [options]\n\n"
    "Writes the maps of a folder made by merlin estimate or merlin stereo (or its maps.exr) as engines, 3-D programs\n"
    "and machines read them: the square around the object, continued beside it, so that textures have no dark edge.\n\n"
    "      --maps LIST      which, with commas between them (default: albedo,normal,roughness,ao,height,alpha):\n"
    "                         albedo      albedo.png, sRGB\n"
    "                         normal      normal.png, 16 bits, tangent space of a plane that faces the camera\n"
    "                         roughness   roughness.png\n"
    "                         smoothness  smoothness.png, 1 - roughness\n"
    "                         ao          ao.png, ambient occlusion\n"
    "                         orm         orm.png: occlusion, roughness, metalness (0) as red, green and blue\n"
    "                         height      height.png, 16 bits, lowest 0, highest 1\n"
    "                         height32    height.exr, 32 bits, in widths of the square\n"
    "                         alpha       alpha.png, how much of a pixel the object covers\n"
    "                         materialx   material.mtlx, with albedo, normal and roughness\n"
    "                         all         all of these; with --normal-y down without materialx\n"
    "      --normal-y WAY   up (default): green is larger where the surface faces upwards (OpenGL, Blender, Unity);\n"
    "                       down: downwards (DirectX, Unreal)\n"
    "      --size N         pixels a side, 64 to 8192 (default: the square's, at most 2048)\n"
    "  -o, --output DIR     where to (default: export inside DIR)\n"
    "      --json           a report as JSON on standard output\n"
    "  -t, --threads N      how many threads work (default: one a processor)\n"
    "  -q, --quiet          no other output than errors\n"
    "  -h, --help           this text\n\n"
    "export.json says how high the relief is: what a displacement of height.png on a plane of width 1 is scaled by.\n"
    "Meshes are written by --mesh of merlin estimate and merlin stereo.\n";

static const char *const map_names[] = {"albedo", "normal",   "roughness", "smoothness", "ao",  "orm",
                                        "height", "height32", "alpha",     "materialx",  "all", NULL};
static const unsigned map_bits[] = {
    MERLIN_EXPORT_ALBEDO,    MERLIN_EXPORT_NORMAL,    MERLIN_EXPORT_ROUGHNESS, MERLIN_EXPORT_SMOOTHNESS,
    MERLIN_EXPORT_OCCLUSION, MERLIN_EXPORT_ORM,       MERLIN_EXPORT_HEIGHT,    MERLIN_EXPORT_HEIGHT_FLOAT,
    MERLIN_EXPORT_ALPHA,     MERLIN_EXPORT_MATERIALX, MERLIN_EXPORT_ALL,
};
enum { LONGEST_MAP_NAME = 16 };

typedef struct request {
    const char *input, *output;
    merlin_export_params params;
    bool json, quiet, help;
} request;

static status take_map_name(const char *name, unsigned *maps)
{
    for (int i = 0; map_names[i]; i++)
        if (strcmp(name, map_names[i]) == 0) {
            *maps |= map_bits[i];
            return OK;
        }
    return fail(MERLIN_WRONG_USE,
                "--maps knows no \"%s\", but albedo, normal, roughness, smoothness, ao, orm, height, "
                "height32, alpha, materialx and all",
                name);
}

static status take_maps(const char *value, void *into)
{
    unsigned *maps = into;
    char name[LONGEST_MAP_NAME];
    for (const char *at = value;; at++) {
        size_t length = strcspn(at, ",");
        snprintf(name, sizeof name, "%.*s", (int)length, at);
        status s = take_map_name(name, maps);
        if (s != OK) return s;
        at += length;
        if (!*at) return OK;
    }
}

static status take_way(const char *value, void *into)
{
    int *down = into;
    *down = strcmp(value, "down") == 0;
    if (*down || strcmp(value, "up") == 0) return OK;
    return fail(MERLIN_WRONG_USE, "--normal-y is up or down, not \"%s\"", value);
}

static status parse(int *argc, char ***argv, request *r)
{
    const cli_option options[] = {
        {"maps", .take = take_maps, .into = &r->params.maps},
        {"normal-y", .take = take_way, .into = &r->params.normal_down},
        {"size", .integer = &r->params.side, .low = MERLIN_EXPORT_LEAST_SIDE, .high = MERLIN_EXPORT_MOST_SIDE},
        {"output", 'o', .folder = &r->output},
        {"json", .flag = &r->json},
        {"quiet", 'q', .flag = &r->quiet},
        {"help", 'h', .flag = &r->help},
        {0},
    };
    status s = cli_read_options(argc, argv, options);
    if (s != OK || r->help) return s;
    return maps_folder_take(*argc, *argv, &r->input);
}

static void find_doubts(const request *r, warnings *doubts)
{
    if (r->params.maps == MERLIN_EXPORT_ALL && r->params.normal_down)
        warnings_add(doubts, "materialx_left_out",
                     "material.mtlx is left out, as MaterialX has normals whose green is up alone");
}

static status announce(const request *r, const char *output, const merlin_export_facts *facts,
                       const merlin_files *written, double seconds)
{
    char amount[WRITTEN_WORDS];
    if (!r->json && !r->quiet)
        printf("%s: %s, %d x %d, relief %.3f of its width (%.2f s, %s)\n", r->input, output, facts->side, facts->side,
               (double)facts->relief, seconds, written_words(written, amount));
    warnings doubts = {0};
    find_doubts(r, &doubts);
    if (!r->quiet) warnings_print(&doubts, "export", r->input, WARNINGS_MOST);
    if (!r->json) return OK;
    cJSON *report = report_begin(&doubts);
    json_put_text(report, "input", r->input);
    json_line_files(report, output, written);
    json_put_number(report, "side", facts->side);
    json_put_number(report, "relief", (double)facts->relief);
    json_put_number(report, "width", (double)facts->width);
    json_put_number(report, "seconds_total", seconds);
    status s = json_line_print(report);
    cJSON_Delete(report);
    return s;
}

static status run(const request *r)
{
    const double began = clock_seconds();
    merlin_maps maps = {0};
    merlin_export_facts facts = {0};
    merlin_files written = {0};
    char *output = photo_output_inside(r->input, "export", r->output);
    if (!output) return fail(MERLIN_NO_MEMORY, "no memory for a file name");
    status s = maps_folder_check(r->input, "makes one");
    if (s == OK) s = check_output(output);
    if (s == OK) s = merlin_maps_read(r->input, &maps);
    if (s == OK) s = merlin_maps_export(&maps, &r->params, output, &facts, &written);
    if (s == OK) s = announce(r, output, &facts, &written, clock_seconds() - began);
    if (s == MERLIN_STOPPED) s = fail(s, "interrupted; nothing was written to %s", output);
    merlin_files_free(&written);
    merlin_maps_free(&maps);
    free(output);
    return s;
}

int cmd_export(int argc, char **argv)
{
    request r = {.params.stop = cli_interrupted};
    status s = parse(&argc, &argv, &r);
    if (s != OK) return cli_refuse("export", s);
    if (r.help) return fputs(help, stdout) < 0;
    cli_catch_interrupts();
    s = run(&r);
    return s == OK ? 0 : cli_fail("export", s);
}
