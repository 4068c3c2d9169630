/* SPDX-License-Identifier: MIT */
/* merlin relight: the object of a photograph under other light. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/progress.h"
#include "base/text/report.h"
#include "base/warnings.h"
#include "cli/commands.h"
#include "cli/expect.h"
#include "cli/relight/lamps.h"
#include "cli/relight/relight_help.h"
#include "cli/relight/relight_output.h"
#include "cli/relight/relight_rti.h"
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

/* --exposure */
typedef struct exposing {
    bool given, automatic;
    float ev;
} exposing;

/* --format */
typedef struct formatting {
    bool given;
    merlin_image_format format;
} formatting;

typedef struct request {
    const char *input, *list, *mask, *model, *output, *env;
    float rotate, env_exposure, radius;
    lamp_options lamps;
    merlin_params params;
    merlin_relighting how;
    exposing exposing;
    formatting format;
    int orbit, frame;
    relight_dome dome;
    relight_rti rti;
    bool sequence; /* whether input is a folder of frames */
    bool found, near, together, no_shadows, no_bounces, matte, json, quiet, help;
    int captured; /* whether input is a capture's maps */
} request;

static status take_exposing(const char *text, void *into)
{
    exposing *e = into;
    double ev = 0;
    *e = (exposing){.given = true, .automatic = strcmp(text, "auto") == 0};
    status s = e->automatic ? OK : cli_float("--exposure", text, -20, 20, &ev);
    e->ev = (float)ev;
    return s;
}

static status take_format(const char *text, void *into)
{
    formatting *f = into;
    f->given = true;
    if (strcmp(text, "png") == 0)
        f->format = MERLIN_PNG;
    else if (strcmp(text, "jpg") == 0 || strcmp(text, "jpeg") == 0)
        f->format = MERLIN_JPEG;
    else
        return fail(MERLIN_WRONG_USE, "--format wants png or jpg, not \"%s\"", text);
    return OK;
}

static status take_radius(const char *text, void *into)
{
    double radius = 0;
    status s = cli_float("--radius", text, 0.1, 1000, &radius);
    *(float *)into = (float)radius;
    return s;
}

static status take_way(const char *text, void *into)
{
    merlin_relighting *how = into;
    if (strcmp(text, "brdf") == 0)
        *how = MERLIN_BY_BRDF;
    else if (strcmp(text, "network") == 0)
        *how = MERLIN_BY_NETWORK;
    else
        return fail(MERLIN_WRONG_USE, "--by wants brdf or network, not \"%s\"", text);
    return OK;
}

static bool to_standard_output(const request *r)
{
    return r->output && strcmp(r->output, "-") == 0;
}

static status check_dome(request *r)
{
    int count = r->dome.count;
    if (r->dome.lp && count == 0) return fail(MERLIN_WRONG_USE, "--lp lists the lights of a --dome");
    if (r->near && count == 0 && !r->list)
        return fail(MERLIN_WRONG_USE, "--near is of the lamps of a --dome or an .lp file");
    if (r->radius > 0 && !r->near) return fail(MERLIN_WRONG_USE, "--radius is of --near lamps");
    if (r->near && r->dome.lp)
        return fail(MERLIN_WRONG_USE, "--lp lists distant lights, and --near has none: their places go to lights.txt");
    if (r->how == MERLIN_BY_NETWORK && count && !r->near)
        return fail(MERLIN_WRONG_USE, "the relighting decoder knows no distant lights: give --near, too");
    if (r->env && count) return fail(MERLIN_WRONG_USE, "--dome is of lamps alone, without --env");
    r->dome.near = r->near ? r->radius > 0 ? r->radius : 1 : 0;
    if (r->output && file_ends_in(r->output, ".ptm")) r->rti.file = file_name_of(r->output);
    if (r->rti.file && !r->rti.wanted)
        return fail(MERLIN_WRONG_USE, "%s is a file of --rti ptm or lrgb with a --dome, or of no kind that is known",
                    r->output);
    const bool other = r->lamps.count || r->list || r->orbit || r->dome.lp || r->format.given;
    return r->rti.wanted ? relight_rti_check(&r->rti, count, r->near, other) : OK;
}

static status check_standard_output(const request *r)
{
    if (!to_standard_output(r)) return OK;
    if (r->orbit || r->dome.count || (r->lamps.count > 1 && !r->together))
        return fail(MERLIN_WRONG_USE, "-o - writes one picture to standard output; for several name a folder");
    if (r->json)
        return fail(MERLIN_WRONG_USE, "-o - leaves standard output to the picture; there is no room for --json");
    return OK;
}

static status check_way(request *r)
{
    bool by_network = r->how == MERLIN_BY_NETWORK;
    if (r->no_shadows && by_network)
        return fail(MERLIN_WRONG_USE, "--no-shadows is of --by brdf; the relighting decoder paints its own");
    if (r->no_bounces && by_network)
        return fail(MERLIN_WRONG_USE, "--no-bounces is of --by brdf; the relighting decoder paints its own");
    if (r->no_bounces && r->no_shadows)
        return fail(MERLIN_WRONG_USE, "--no-bounces keeps cast shadows: give it or --no-shadows, not both");
    if (r->matte && by_network)
        return fail(MERLIN_WRONG_USE, "--matte is of --by brdf; the relighting decoder paints gloss");
    if (r->together && by_network)
        return fail(MERLIN_WRONG_USE, "--together is of --by brdf; the relighting decoder knows one lamp alone");
    if (r->found && by_network)
        return fail(MERLIN_WRONG_USE, "--found-light is of --by brdf; the relighting decoder knows one lamp alone");
    status s = merlin_maps_look(r->input, &r->captured);
    if (by_network && r->captured)
        return fail(MERLIN_WRONG_USE, "--by network wants a photograph; %s holds the maps of merlin stereo", r->input);
    if (r->no_shadows || r->no_bounces) r->how = r->no_shadows ? MERLIN_BY_BRDF_UNSHADOWED : MERLIN_BY_BRDF_DIRECT;
    return s;
}

/* Checks what a sequence's frames are lit by: one light for all, or an orbit. */
static status check_sequence(const request *r)
{
    if (!r->sequence) return OK;
    if (r->dome.count || r->frame || r->near || to_standard_output(r))
        return fail(MERLIN_WRONG_USE,
                    "%s is a sequence, whose frames have one light: no --dome, --near, --frame and no -o -", r->input);
    if (r->lamps.count > 1 && !r->together)
        return fail(MERLIN_WRONG_USE, "%s is a sequence, whose frames have one light: several lamps want --together",
                    r->input);
    if (r->orbit && r->lamps.count && !r->env)
        return fail(MERLIN_WRONG_USE,
                    "the lamp of a sequence stands still or goes round: --orbit or --light, not both");
    return OK;
}

static status check_photo(const request *r)
{
    if (!file_is_folder(r->input)) return photo_check_hint(&r->params.hint, r->mask, false);
    if (!r->mask && !photo_params_given(&r->params)) return OK;
    return fail(MERLIN_WRONG_USE,
                "--mask, --point, --box, --size, --views and --photo-exposure are for a photograph; %s holds maps "
                "already",
                r->input);
}

static status check(request *r)
{
    if (r->lamps.count == 0 && !r->list && r->orbit == 0 && r->dome.count == 0 && !r->env && !r->found)
        return fail(MERLIN_WRONG_USE,
                    "no light: give --light, --direction, --lights, --orbit, --dome, --env or --found-light");
    if (!r->env && r->env_exposure != 0) return fail(MERLIN_WRONG_USE, "--env-exposure wants an --env");
    if (!r->env && !r->found && r->rotate != 0)
        return fail(MERLIN_WRONG_USE, "--rotate wants an --env or the --found-light to turn");
    if (r->found && (r->lamps.count || r->list || r->dome.count || r->env))
        return fail(MERLIN_WRONG_USE,
                    "--found-light comes alone: without --light, --direction, --lights, --dome and --env");
    if (r->found && r->exposing.automatic)
        return fail(MERLIN_WRONG_USE, "--found-light is exposed as the photograph is, or brighter by --exposure EV");
    if (r->together && ((r->lamps.count == 0 && !r->list) || r->dome.count))
        return fail(MERLIN_WRONG_USE, "--together is of the lamps of --light, --direction and --lights");
    if (r->together && r->orbit && !r->env)
        return fail(MERLIN_WRONG_USE, "--together goes with an --orbit of an --env, beside which its lamps stand");
    const bool lamps = r->lamps.count || r->list || r->dome.count || (r->orbit && !r->env && !r->found);
    if (!lamps && (r->lamps.common.has_power || r->lamps.common.has_color))
        return fail(MERLIN_WRONG_USE, "--power and --color are of lamps; %s",
                    r->env ? "surroundings are made brighter by --env-exposure"
                           : "the found light is made brighter by --exposure");
    if (r->frame && r->orbit == 0) return fail(MERLIN_WRONG_USE, "--frame is the side of an --orbit's frames");
    const bool whole = r->lamps.count || r->list || r->dome.count || r->env || r->found;
    if (r->format.given && !whole && !r->sequence)
        return fail(MERLIN_WRONG_USE, "--format is of pictures of the photograph's size; an --orbit's frames are PNG");
    status s = check_dome(r);
    if (s == OK) s = check_standard_output(r);
    if (s == OK) s = check_sequence(r);
    if (s == OK) s = check_photo(r);
    return s == OK ? check_way(r) : s;
}

static status parse(int *argc, char ***argv, request *r)
{
    const cli_option options[] = {
        {"light", .take = lamp_take_light, .into = &r->lamps, .many = true},
        {"direction", .take = lamp_take_direction, .into = &r->lamps, .many = true},
        {"lights", .text = &r->list},
        {"together", .flag = &r->together},
        {"orbit", .integer = &r->orbit, .low = 2, .high = RELIGHT_MOST_FRAMES},
        {"dome", .integer = &r->dome.count, .low = 3, .high = RELIGHT_MOST_DOME},
        {"lp", .flag = &r->dome.lp},
        {"rti", .take = relight_take_rti, .into = &r->rti},
        {"near", .flag = &r->near},
        {"radius", .take = take_radius, .into = &r->radius},
        {"power", .take = lamp_take_power, .into = &r->lamps, .many = true},
        {"color", .take = lamp_take_color, .into = &r->lamps, .many = true},
        {"exposure", .take = take_exposing, .into = &r->exposing},
        {"format", .take = take_format, .into = &r->format},
        {"env", .text = &r->env},
        {"found-light", .flag = &r->found},
        {"rotate", .real = &r->rotate, .low = -1000000, .high = 1000000},
        {"env-exposure", .real = &r->env_exposure, .low = -20, .high = 20},
        {"by", .take = take_way, .into = &r->how},
        {"no-shadows", .flag = &r->no_shadows},
        {"no-bounces", .flag = &r->no_bounces},
        {"matte", .flag = &r->matte},
        {"frame", .integer = &r->frame, .low = 32, .high = 1024},
        {"mask", .text = &r->mask},
        {"point", .take = photo_take_point, .into = &r->params.hint, .many = true},
        {"box", .take = photo_take_box, .into = &r->params.hint},
        {"size", .take = photo_take_size, .into = &r->params},
        {"views", .integer = &r->params.views, .low = 1, .high = 8},
        {"photo-exposure", .take = photo_take_exposure, .into = &r->params},
        {"model", .text = &r->model},
        {"output", 'o', .folder = &r->output, .printed = true},
        {"json", .flag = &r->json},
        {"quiet", 'q', .flag = &r->quiet},
        {"help", 'h', .flag = &r->help},
        {0},
    };
    status s = cli_read_options(argc, argv, options);
    if (s != OK || r->help) return s;
    if (*argc == 0) return fail(MERLIN_WRONG_USE, "no photograph or folder given");
    if (*argc > 1) return fail(MERLIN_WRONG_USE, "one photograph or folder at a time, not also %s", (*argv)[1]);
    s = photo_take_input(*argv, r->output, &r->input);
    if (s == OK && merlin_frames_are(r->input))
        s = fail(MERLIN_WRONG_USE, "%s is a sequence: merlin estimate %s, then relight the folder that this writes",
                 r->input, r->input);
    r->sequence = s == OK && merlin_sequence_is(r->input);
    return s == OK ? check(r) : s;
}

/* Checks the lamps of options and of a list. */
static status check_lamps(const request *r)
{
    status s = OK;
    if (r->env && r->orbit && r->lamps.count > 1 && !r->together)
        return fail(MERLIN_WRONG_USE, "an --orbit of the --env goes round beside one --light, not %zu", r->lamps.count);
    for (size_t i = 0; i < r->lamps.count && s == OK; i++)
        s = merlin_relighting_check(r->how, &r->lamps.at[i], r->env != NULL);
    if (s == OK && r->env && r->lamps.count == 0) s = merlin_relighting_check(r->how, NULL, 1);
    if (s == OK) s = check_sequence(r); /* with the lamps of a list */
    return s == OK ? check_standard_output(r) : s;
}

static status read_lamps(request *r)
{
    status s = r->list ? lamp_read_list(r->list, r->dome.near, &r->lamps) : OK;
    return s == OK ? check_lamps(r) : s;
}

/* Gets maps from a folder of estimate or stereo, or of a sequence's first frame, and the model that relights them; or
 * estimates them by it now. */
static status get_maps(request *r, const merlin_sequence_files *frames, const watch *shown, merlin_model **model,
                       merlin_maps *maps)
{
    const bool folder = file_is_folder(r->input);
    char *weights = NULL, *flash = NULL;
    status s = folder ? merlin_maps_read(frames->count ? frames->at[0].folder : r->input, maps) : OK;
    if (s == OK) s = photo_find_models_of(maps, r->model, &weights, &flash);
    if (s == OK) s = photo_open_models(weights, flash, model);
    free(weights);
    free(flash);
    if (s != OK || folder) return s;
    r->params.progress = shown->tell, r->params.progress_context = shown->context;
    return photo_maps(*model, r->input, r->mask, &r->params, maps);
}

/* ---- report ---- */

static bool has_lamps(const relight_job *job)
{
    return job->lamps.count || job->dome.count || !job->environment;
}

/* Lists the warnings about the photograph first, if the maps are estimated now. */
static void find_doubts(const relight_job *job, const relight_result *result, warnings *doubts)
{
    merlin_maps_warnings(job->maps, doubts);
    warnings_append(doubts, &job->lamps.noticed);
    if (has_lamps(job)) merlin_relighting_warnings(job->model, job->maps, job->how, doubts);
    relit_light_warn_negative(merlin_environment_negative(job->environment), doubts);
    relit_light_warn(&result->seen,
                     job->exposing == RELIGHT_AS_SOURCE ? "--exposure auto or an EV below 0" : "--exposure EV", doubts);
    if (*result->no_video)
        warnings_add(doubts, "no_video", "the frames were not written as a video, too: %s", result->no_video);
    if (result->left > 0)
        warnings_add(doubts, "pictures_left", "%zu picture%s of an earlier run %s still beside these, %s first",
                     result->left, result->left == 1 ? "" : "s", result->left == 1 ? "is" : "are", result->left_name);
}

static status print_json(const request *r, const relight_job *job, const relight_result *result, double seconds)
{
    warnings doubts;
    find_doubts(job, result, &doubts);
    cJSON *report = report_begin(&doubts);
    json_put_text(report, "input", standard_input_is(r->input) ? "-" : r->input);
    json_line_files(report, job->output, &result->files);
    json_put_number(report, "lights", (double)job->lamps.count);
    json_put_number(report, "orbit", job->orbit);
    json_put_number(report, "dome", job->dome.count);
    if (job->frames) json_put_number(report, "sequence", (double)job->frames->count);
    if (job->rti.wanted) json_put_text(report, "rti", relight_rti_name(&job->rti));
    json_put_text(report, "by", r->how == MERLIN_BY_NETWORK ? "network" : "brdf");
    json_put_text(report, "model", merlin_relighting_model(job->model, job->maps, job->how));
    json_put_number(report, "exposure", round(100 * (double)result->ev) / 100);
    json_put_number(report, "burnt_out", round(1e4 * result->seen.burnt_out) / 1e4);
    json_put_number(report, "seconds_total", seconds);
    status s = json_line_print(report);
    cJSON_Delete(report);
    return s;
}

static status announce(const request *r, const relight_job *job, const relight_result *result, double seconds)
{
    warnings doubts;
    find_doubts(job, result, &doubts);
    if (!r->quiet) warnings_print(&doubts, "relight", standard_input_name(r->input), WARNINGS_MOST);
    if (r->json) return print_json(r, job, result, seconds);
    if (r->quiet || to_standard_output(r)) return OK;
    char amount[WRITTEN_WORDS];
    printf("%s: %s (%.2f s", standard_input_name(r->input), job->rti.file ? r->output : job->output, seconds);
    if (fabsf(result->ev) >= 0.005f) printf(", exposure %+.2f EV", (double)result->ev);
    printf(", %s)\n", written_words(&result->files, amount));
    return OK;
}

/* ---- the work ---- */

static relight_job job_of(const request *r, const char *output)
{
    relight_job job = {.output = output,
                       .lamps = r->lamps,
                       .together = r->together,
                       .how = r->how,
                       .matte = r->matte || r->captured,
                       .format = r->format.format,
                       .ev = r->exposing.ev,
                       .dome = r->dome,
                       .rti = r->rti,
                       .found = r->found,
                       .turn = r->rotate,
                       .orbit = r->orbit,
                       .frame = r->frame,
                       .stop = cli_interrupted};
    if (r->exposing.automatic || (!r->exposing.given && r->dome.count))
        job.exposing = RELIGHT_AUTO;
    else if (!r->exposing.given && r->captured)
        job.exposing = RELIGHT_BY_LAMPS;
    return job;
}

/* Plans the progress by the sizes of files, before they are read. */
static void plan(const request *r, stage_bar *bar)
{
    stage_cost stages[STAGE_BAR_MOST];
    double pixels = expect_pixels(r->input), lamps = (r->together ? 1 : (double)r->lamps.count) + r->dome.count;
    size_t count = expect_estimate(pixels, stages, 0);
    expect_relight how = {.pixels = pixels,
                          .pictures = (r->env || r->found) && r->lamps.count == 0 ? lamps + 1 : lamps,
                          .frames = r->orbit,
                          .environment = r->env || r->found};
    if (file_is_folder(r->input)) count = expect_maps(pixels, stages, 0);
    stage_bar_plan(bar, stages, expect_relit(&how, stages, count));
}

static status relight(request *r, const char *output)
{
    double began = clock_seconds();
    relight_result result = {0};
    relight_job job = job_of(r, output);
    job.inputs = (const char *const[STAGING_MOST_INPUTS]){r->input, r->mask, r->env, r->list};
    merlin_maps maps = {0};
    merlin_environment *environment = NULL;
    merlin_sequence_files frames = {.count = 0};
    stage_bar bar;
    status s = OK;
    stage_bar_begin(&bar, r->quiet);
    plan(r, &bar);
    const watch shown = stage_bar_watch(&bar);
    job.watch = &shown;
    watch_tell(&shown, "reading", 0);
    if (r->env) s = merlin_environment_read(r->env, r->rotate, r->env_exposure, &environment);
    job.environment = environment;
    if (s == OK && r->sequence) s = merlin_sequence_read(r->input, &frames);
    if (r->sequence) job.frames = &frames;
    if (s == OK) s = get_maps(r, &frames, &shown, &job.model, &maps);
    job.maps = &maps;
    if (s == OK) s = to_standard_output(r) ? relight_print(&job, &result) : relight_output(&job, &result);
    stage_bar_end(&bar);
    if (s == OK) s = announce(r, &job, &result, clock_seconds() - began);
    merlin_files_free(&result.files);
    merlin_maps_free(&maps);
    merlin_model_close(job.model);
    merlin_environment_free(environment);
    merlin_sequence_files_free(&frames);
    return s == MERLIN_STOPPED ? fail(s, "interrupted; nothing was written to %s", output) : s;
}

static status run(request *r)
{
    char *output = r->rti.file ? file_folder_of(r->output)
                               : photo_output_inside(r->input, r->rti.wanted ? "rti" : "relit", r->output);
    status s = output ? read_lamps(r) : fail(MERLIN_NO_MEMORY, "no memory for a file name");
    if (s == OK && !file_exists(r->input)) s = fail(MERLIN_BAD_INPUT, "there is no photograph or folder %s", r->input);
    if (s == OK) s = check_photo_and_mask(r->input, r->mask);
    if (s == OK && !to_standard_output(r)) s = check_output(output);
    if (s == OK) s = relight(r, output);
    free(output);
    return s;
}

int cmd_relight(int argc, char **argv)
{
    request r = {.params = merlin_params_default(), .lamps = lamp_options_new()};
    r.params.stop = cli_interrupted;
    int code = 0;
    status s = parse(&argc, &argv, &r);
    if (s != OK) {
        code = cli_refuse("relight", s);
    } else if (r.help) {
        relight_print_help();
    } else {
        cli_catch_interrupts();
        s = run(&r);
        if (s != OK) code = cli_fail("relight", s);
    }
    lamp_options_free(&r.lamps);
    return code;
}
