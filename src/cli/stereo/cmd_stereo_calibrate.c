/* SPDX-License-Identifier: MIT */
/* merlin stereo calibrate: light directions from pictures of a ball. */
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#include "base/json/json_put.h"
#include "base/progress.h"
#include "base/skipped.h"
#include "base/text/report.h"
#include "cli/check_replaced.h"
#include "cli/stage_bar.h"
#include "cli/stereo/stereo_commands.h"
#include "command/cli.h"
#include "command/json_line.h"
#include "command/options.h"
#include "merlin/calibrate.h"

static const char help[] =
    "usage: merlin stereo calibrate --sphere chrome|matte DIR [options]\n\n"
    "Finds the direction of each light from pictures of a ball, one picture a light: from the highlight on a chrome\n"
    "ball, from the shading of a matte one. The ball is searched for where there is no mask of it.\n\n"
    "      --sphere KIND  chrome or matte\n"
    "      --mask FILE    white on the ball (default: mask.png or the like in DIR, else the ball is\n"
    "                     searched for)\n"
    "      --linear       8-bit pictures are linear already, not sRGB\n"
    "      --fov DEG      the camera's horizontal field of view (default: by EXIF, else as seen from afar)\n"
    "  -o, --output DIR   where to (default: DIR itself)\n"
    "      --json         a report as JSON on standard output\n"
    "  -t, --threads N    how many threads work (default: one a processor)\n"
    "  -q, --quiet        no other output than errors\n"
    "  -h, --help         this text\n\n"
    "Writes lights.txt (x y z a line; x right, y up, z toward the camera), in the order of the pictures' names (9.png\n"
    "before 10.png), and calibration.png, which shows what was found.\n";

typedef struct request {
    const char *input, *output;
    merlin_calibrate_params options;
    bool chosen, linear, json, quiet, help;
} request;

static status take_ball(const char *text, void *into)
{
    request *r = into;
    r->chosen = true;
    if (strcmp(text, "chrome") == 0)
        r->options.ball = MERLIN_CHROME_BALL;
    else if (strcmp(text, "matte") == 0)
        r->options.ball = MERLIN_MATTE_BALL;
    else
        return fail(MERLIN_WRONG_USE, "--sphere wants chrome or matte, not \"%s\"", text);
    return OK;
}

static status parse(int *argc, char ***argv, request *r)
{
    const cli_option options[] = {
        {"sphere", .take = take_ball, .into = r},
        {"mask", .text = &r->options.mask},
        {"linear", .flag = &r->linear},
        {"fov", .real = &r->options.field_of_view, .low = 1, .high = 170},
        {"output", 'o', .folder = &r->output},
        {"json", .flag = &r->json},
        {"quiet", 'q', .flag = &r->quiet},
        {"help", 'h', .flag = &r->help},
        {0},
    };
    status s = cli_read_options(argc, argv, options);
    if (s != OK || r->help) return s;
    if (*argc == 0) return fail(MERLIN_WRONG_USE, "no folder with pictures of a ball given");
    if (*argc > 1) return fail(MERLIN_WRONG_USE, "one folder at a time, not also %s", (*argv)[1]);
    if (!r->chosen) return fail(MERLIN_WRONG_USE, "say what the ball is: --sphere chrome or --sphere matte");
    r->input = (*argv)[0];
    if (!r->output) r->output = r->input;
    return OK;
}

static status print_json(const request *r, const merlin_calibration *c, const staged_files *written, double seconds)
{
    warnings all = c->warnings;
    skipped_warn(&c->skipped, &all);
    cJSON *report = report_begin(&all);
    if (c->skipped.count) skipped_json(&c->skipped, r->input, json_put_array(report, "skipped"));
    json_put_text(report, "input", r->input);
    json_line_files(report, r->output, written);
    json_put_number(report, "lights", c->count);
    json_put_text(report, "sphere", c->ball == MERLIN_CHROME_BALL ? "chrome" : "matte");
    json_put_item(report, "circle",
                  cJSON_CreateFloatArray((const float[]){c->circle.x, c->circle.y, c->circle.radius}, 3));
    json_put_bool(report, "from_mask", c->from_mask);
    cJSON *directions = json_put_array(report, "directions");
    for (int i = 0; i < c->count; i++) {
        const float *d = c->lights[i].direction;
        json_append(directions, cJSON_CreateDoubleArray((const double[]){(double)d[0], (double)d[1], (double)d[2]}, 3));
    }
    json_put_number(report, "seconds_total", seconds);
    status s = json_line_print(report);
    cJSON_Delete(report);
    return s;
}

static status announce(const request *r, const merlin_calibration *c, const staged_files *written, double seconds)
{
    if (r->json) return print_json(r, c, written, seconds);
    if (!r->quiet)
        printf("%s: %d light%s in %s/lights.txt; the ball %s at %.1f, %.1f with radius %.1f (%.2f s)\n", r->input,
               c->count, c->count == 1 ? "" : "s", r->output, c->from_mask ? "of the mask is" : "was found",
               (double)c->circle.x, (double)c->circle.y, (double)c->circle.radius, seconds);
    return OK;
}

static status interrupted(const request *r)
{
    return fail(MERLIN_STOPPED, "interrupted; nothing was written to %s", r->output);
}

static status run(request *r)
{
    double began = clock_seconds();
    status s = check_list_replaced(r->output);
    if (s != OK) return s;
    merlin_calibration c;
    staged_files written = {0};
    stage_bar bar;
    stage_bar_begin(&bar, r->quiet);
    stage_bar_plan(&bar, (const stage_cost[]){{"reading", 1}}, 1);
    const watch shown = stage_bar_watch(&bar);
    r->options.linear = r->linear;
    r->options.progress = shown.tell;
    r->options.progress_context = shown.context;
    r->options.stop = shown.stop;
    s = merlin_calibrate(r->input, &r->options, &c);
    stage_bar_end(&bar);
    if (s == MERLIN_STOPPED) return interrupted(r);
    if (s != OK) return s;
    if (cli_interrupted()) s = interrupted(r);
    if (s == OK) s = merlin_calibration_write(&c, r->output, &written);
    if (s == OK) s = announce(r, &c, &written, clock_seconds() - began);
    if (s == OK && !r->quiet) {
        warnings_print(&c.warnings, "stereo calibrate", r->input, 3);
        skipped_print(&c.skipped, "stereo calibrate", r->input);
    }
    merlin_files_free(&written);
    merlin_calibration_free(&c);
    return s;
}

int stereo_calibrate(int argc, char **argv)
{
    request r = {0};
    if (parse(&argc, &argv, &r) != OK) return cli_usage("stereo calibrate", "%s", status_message());
    if (r.help) return fputs(help, stdout) < 0;
    cli_catch_interrupts();
    status s = run(&r);
    return s == OK ? 0 : cli_fail("stereo calibrate", s);
}
