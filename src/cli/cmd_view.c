/* SPDX-License-Identifier: MIT */
/* merlin view: writes maps as a page that a browser opens and relights. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/progress.h"
#include "base/staging.h"
#include "base/text/report.h"
#include "base/warnings.h"
#include "cli/commands.h"
#include "cli/expect.h"
#include "cli/maps_folder.h"
#include "cli/page.h"
#include "cli/stage_bar.h"
#include "cli/written.h"
#include "command/cli.h"
#include "command/json_line.h"
#include "command/options.h"
#include "command/photos.h"
#include "merlin/view.h"

static const char help[] =
    "usage: merlin view DIR [-o FILE] [options]\n\n"
    "Writes the maps of a folder made by merlin estimate or merlin stereo (or its maps.exr) as one HTML file, which a\n"
    "browser opens from the disk, offline: the object under lamps that follow the pointer and in rooms, beside the\n"
    "photograph, turned about, and every map. Light falls as merlin relight --no-bounces has it.\n\n"
    "  -o, --output FILE    where to, ends in .html or .htm (default: viewer.html in DIR)\n"
    "      --size N         pixels a side at most, 64 to 4096 (default 2048); larger squares around the object are\n"
    "                       made smaller\n"
    "      --json           a report as JSON on standard output\n"
    "  -t, --threads N      how many threads work (default: one a processor)\n"
    "  -q, --quiet          no other output than errors\n"
    "  -h, --help           this text\n";

typedef struct request {
    const char *input, *output;
    int side;
    bool json, quiet, help;
} request;

static status parse(int *argc, char ***argv, request *r)
{
    const cli_option options[] = {
        {"output", 'o', .text = &r->output},
        {"size", .integer = &r->side, .low = MERLIN_VIEW_LEAST_SIDE, .high = MERLIN_VIEW_MOST_SIDE},
        {"json", .flag = &r->json},
        {"quiet", 'q', .flag = &r->quiet},
        {"help", 'h', .flag = &r->help},
        {0},
    };
    status s = cli_read_options(argc, argv, options);
    if (s != OK || r->help) return s;
    return maps_folder_take(*argc, *argv, &r->input);
}

/* ---- report ---- */

static status print_json(const request *r, const char *folder, const staged_files *written, const warnings *doubts,
                         double seconds)
{
    cJSON *report = report_begin(doubts);
    json_put_text(report, "input", r->input);
    json_line_files(report, folder, written);
    json_put_number(report, "seconds_total", seconds);
    status s = json_line_print(report);
    cJSON_Delete(report);
    return s;
}

static status announce(const request *r, const merlin_maps *maps, const char *folder, const staged_files *written,
                       double seconds)
{
    warnings doubts;
    char amount[WRITTEN_WORDS];
    merlin_maps_warnings(maps, &doubts);
    page_doubt(maps->crop.side, r->side, &doubts);
    if (!r->quiet) warnings_print(&doubts, "view", r->input, WARNINGS_MOST);
    if (r->json) return print_json(r, folder, written, &doubts, seconds);
    if (!r->quiet)
        printf("%s: %s (%.2f s, %s)\n", r->input,
               r->output        ? r->output
               : written->count ? written->at[0]
                                : folder,
               seconds, written_words(written, amount));
    return OK;
}

/* ---- the work ---- */

static status write_page(const request *r, const merlin_maps *maps, staging *t, const char *file)
{
    char path[PATH_MAX];
    const page_source of = {r->input, r->input, r->side};
    status s = page_write(maps, &of, staging_path(t, file, path));
    return s == OK && cli_interrupted() ? fail(MERLIN_STOPPED, "stopped") : s;
}

/* Writes the page; file: its name in the folder. */
static status view(const request *r, const char *folder, const char *file)
{
    const double began = clock_seconds(), pixels = expect_pixels(r->input);
    merlin_maps maps = {0};
    staged_files written = {0};
    staging *t = NULL;
    stage_bar bar;
    stage_cost stages[STAGE_BAR_MOST];
    size_t count = expect_maps(pixels, stages, 0);
    stages[count++] = (stage_cost){"writing", page_cost(pixels)};
    stage_bar_begin(&bar, r->quiet);
    stage_bar_plan(&bar, stages, count);
    const watch shown = stage_bar_watch(&bar);
    status s = staging_begin(folder, NULL, &t);
    if (s == OK) watch_tell(&shown, "reading", 0);
    if (s == OK) s = merlin_maps_read(r->input, &maps);
    if (s == OK) watch_tell(&shown, "writing", 0);
    if (s == OK) s = write_page(r, &maps, t, file);
    if (t) s = s == OK ? staging_commit(t, &written) : staging_abort(t, s);
    stage_bar_end(&bar);
    if (s == OK) s = announce(r, &maps, folder, &written, clock_seconds() - began);
    merlin_files_free(&written);
    merlin_maps_free(&maps);
    return s == MERLIN_STOPPED ? fail(s, "interrupted; nothing was written to %s", folder) : s;
}

static status run(const request *r)
{
    status s = maps_folder_check(r->input, "--html makes one, with its page");
    if (s != OK) return s;
    char *folder = r->output ? file_folder_of(r->output) : strdup(r->input);
    s = folder ? view(r, folder, r->output ? file_name_of(r->output) : PAGE_FILE)
               : fail(MERLIN_NO_MEMORY, "no memory for a file name");
    free(folder);
    return s;
}

int cmd_view(int argc, char **argv)
{
    request r = {.side = 0};
    status s = parse(&argc, &argv, &r);
    if (s != OK) return cli_refuse("view", s);
    if (r.help) return fputs(help, stdout) < 0;
    cli_catch_interrupts();
    s = run(&r);
    return s == OK ? 0 : cli_fail("view", s);
}
