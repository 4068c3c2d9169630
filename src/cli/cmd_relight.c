/* merlin relight: the object of a photograph under other light. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/light_list.h"
#include "base/progress.h"
#include "cli/cli.h"
#include "cli/json_line.h"
#include "cli/options.h"
#include "cli/photo_ahead.h"
#include "cli/photo_doubts.h"
#include "cli/photos.h"
#include "cli/relight_output.h"
#include "cli/stereo_maps.h"
#include "estimate/api.h"

static const char help[] =
    "usage: merlin relight PHOTO|DIR --light x,y,z [--light ...] [options]\n"
    "       merlin relight PHOTO|DIR --lights FILE [options]\n"
    "       merlin relight PHOTO|DIR --orbit N [options]\n"
    "       merlin relight PHOTO|DIR --dome N [--lp] [options]\n"
    "       merlin relight PHOTO|DIR --env FILE [--rotate DEG] [--light x,y,z] [--orbit N] [options]\n\n"
    "Shows an object under a point light, an environment, or both instead of the flash. DIR is a folder made by\n"
    "merlin estimate or merlin stereo (whose surfaces have no gloss), or its maps.exr; a PHOTO is estimated first.\n"
    "The camera is at 0,0,0 and looks along -z, x right, y up; the object is near 0,0,-1; the crop around the object\n"
    "counts as a frame 60 degrees wide.\n\n"
    "      --light x,y,z    a light's position; may be given again\n"
    "      --lights FILE    positions from a file: x y z a line, or the directions of an .lp file\n"
    "      --orbit N        N frames (2 to 240) with the light on a circle in front of the object, also as orbit.webp\n"
    "                       and orbit.gif\n"
    "      --dome N         N pictures (3 to 999), dome_000.png and on, under lights spread evenly over the frontal\n"
    "                       hemisphere, and mask.png\n"
    "      --lp             with --dome: dome.lp, the light list of RTI tools and of merlin stereo; that of an\n"
    "                       earlier dome in the same folder is renewed without it, too\n"
    "      --env FILE       surroundings from a latitude-longitude picture (.hdr, .exr), alone or beside each light;\n"
    "                       with --orbit they go round once, and the light stays\n"
    "      --rotate DEG     turns them about the vertical: at 90 what was straight ahead is to the right\n"
    "      --env-exposure EV\n"
    "                       makes them brighter or darker by EV stops (default 0: mean luminance 1)\n"
    "      --by WAY         brdf (default): the maps' BRDF with cast shadows and the network's global illumination;\n"
    "                       network: the relighting decoder, made for lights at distance 1 from 0,0,-1 with z >= -1\n"
    "      --no-shadows     brdf without cast shadows (lights and surroundings), as in the paper\n"
    "  -o, --output DIR     where to (default: relit inside DIR, or inside the photograph's name + .merlin)\n"
    "      --frame N        side of the orbit's frames (default: the crop's, at most 512)\n"
    "      --mask FILE, --size N, --views N, --exposure EV\n"
    "                       for a PHOTO, as in merlin estimate\n"
    "      --model W        weights: merlin-point (flash alone), merlin-env (flash in a room), or a file (default:\n"
    "                       $MERLIN_MODEL, else merlin-point)\n"
    "      --json           a report as JSON on standard output\n"
    "      --quiet          no other output than errors\n"
    "  -h, --help           this text\n\n"
    "Writes relit_000.png and on, and relit.png with all of them; for an orbit frame_000.png and on, and orbit.png.\n";

typedef struct request {
    const char *input, *list, *mask, *weights, *output, *env;
    float rotate, env_exposure;
    light_list lights;
    merlin_params params;
    merlin_relighting how;
    int orbit, frame, dome;
    bool lp, no_shadows, json, quiet, help;
} request;

static status take_light(const char *text, void *lights)
{
    float v[3];
    status s = cli_vec3("--light", text, v);
    return s == OK ? light_list_add(lights, vec3_of(v)) : s;
}

static status take_way(const char *text, void *into)
{
    merlin_relighting *how = into;
    if (strcmp(text, "brdf") == 0)
        *how = MERLIN_BY_BRDF;
    else if (strcmp(text, "network") == 0)
        *how = MERLIN_BY_NETWORK;
    else
        return fail(ERROR_USAGE, "--by wants brdf or network, not \"%s\"", text);
    return OK;
}

static status check(request *r)
{
    if (r->lights.count == 0 && !r->list && r->orbit == 0 && r->dome == 0 && !r->env)
        return fail(ERROR_USAGE, "no light: give --light, --lights, --orbit, --dome or --env");
    if (!r->env && (r->rotate != 0 || r->env_exposure != 0))
        return fail(ERROR_USAGE, "--rotate and --env-exposure want an --env");
    if (r->env && r->dome) return fail(ERROR_USAGE, "--dome is of point lights alone, without --env");
    if (r->frame && r->orbit == 0) return fail(ERROR_USAGE, "--frame is the side of an --orbit's frames");
    if (r->no_shadows && r->how == MERLIN_BY_NETWORK)
        return fail(ERROR_USAGE, "--no-shadows is of --by brdf; the relighting decoder paints its own");
    if (r->no_shadows) r->how = MERLIN_BY_BRDF_UNSHADOWED;
    status s = file_is_folder(r->input) ? photo_check_maps(r->input, r->mask, &r->params) : OK;
    if (s != OK) return s;
    if (r->how == MERLIN_BY_NETWORK && stereo_maps_in(r->input))
        return fail(ERROR_USAGE, "--by network wants a photograph; %s holds the maps of merlin stereo", r->input);
    if (r->lp && r->dome == 0) return fail(ERROR_USAGE, "--lp lists the lights of a --dome");
    return OK;
}

static status parse(int *argc, char ***argv, request *r)
{
    const cli_option options[] = {
        {"light", .take = take_light, .into = &r->lights},
        {"lights", .text = &r->list},
        {"orbit", .integer = &r->orbit, .low = 2, .high = RELIGHT_MOST_FRAMES},
        {"dome", .integer = &r->dome, .low = 3, .high = RELIGHT_MOST_DOME},
        {"lp", .flag = &r->lp},
        {"env", .text = &r->env},
        {"rotate", .real = &r->rotate, .low = -1000000, .high = 1000000},
        {"env-exposure", .real = &r->env_exposure, .low = -20, .high = 20},
        {"by", .take = take_way, .into = &r->how},
        {"no-shadows", .flag = &r->no_shadows},
        {"frame", .integer = &r->frame, .low = 32, .high = 1024},
        {"mask", .text = &r->mask},
        {"size", .take = photo_take_size, .into = &r->params},
        {"views", .integer = &r->params.views, .low = 1, .high = 8},
        {"exposure", .take = photo_take_exposure, .into = &r->params},
        {"model", .text = &r->weights},
        {"output", 'o', .folder = &r->output},
        {"json", .flag = &r->json},
        {"quiet", .flag = &r->quiet},
        {"help", 'h', .flag = &r->help},
        {0},
    };
    status s = cli_read_options(argc, argv, options);
    if (s != OK || r->help) return s;
    if (*argc == 0) return fail(ERROR_USAGE, "no photograph or folder given");
    if (*argc > 1) return fail(ERROR_USAGE, "one photograph or folder at a time, not also %s", (*argv)[1]);
    r->input = photo_without_maps_name((*argv)[0]);
    return check(r);
}

static status read_lights(request *r)
{
    if (!r->list) return OK;
    light_list more;
    status s = light_list_read(r->list, &more);
    if (s != OK) return s;
    for (size_t i = 0; i < more.count && s == OK; i++)
        s = light_list_add(&r->lights, more.at[i]);
    light_list_free(&more);
    return s;
}

/* Those of a list, too. */
static status check_lights(const request *r)
{
    if (!r->env) return OK;
    if (r->orbit && r->lights.count > 1)
        return fail(ERROR_USAGE, "an --orbit of the --env goes round beside one --light, not %zu", r->lights.count);
    return stage_check(r->how, r->lights.count > 0);
}

/* From a folder of estimate's or stereo's, or by estimating now. */
static status get_maps(const request *r, merlin_model *model, merlin_maps *maps)
{
    *maps = (merlin_maps){0};
    if (file_is_folder(r->input))
        return stereo_maps_in(r->input) ? stereo_maps_read(r->input, maps) : (status)merlin_maps_read(r->input, maps);
    status s = photo_maps(model, r->input, r->mask, &r->params, maps);
    if (s == OK && !r->quiet) photo_doubts_print("relight", r->input, maps, NULL);
    return s;
}

static status print_json(const request *r, const relight_job *job, const staged_files *written, double seconds)
{
    cJSON *report = cJSON_CreateObject();
    json_line_text(report, "input", r->input);
    json_line_files(report, job->output, written->at, written->count);
    cJSON_AddNumberToObject(report, "lights", (double)job->lights.count);
    cJSON_AddNumberToObject(report, "orbit", job->orbit);
    cJSON_AddNumberToObject(report, "dome", job->dome);
    cJSON_AddStringToObject(report, "by", r->how == MERLIN_BY_NETWORK ? "network" : "brdf");
    cJSON_AddStringToObject(report, "model", merlin_model_name(job->model));
    cJSON_AddNumberToObject(report, "seconds_total", seconds);
    status s = json_line_print(report);
    cJSON_Delete(report);
    return s;
}

static status announce(const request *r, const relight_job *job, const staged_files *written, double seconds)
{
    if (r->json) return print_json(r, job, written, seconds);
    if (!r->quiet) printf("%s: %s (%.2f s)\n", r->input, job->output, seconds);
    return OK;
}

/* Where there is something to wait for. */
static status write_all(const request *r, const relight_job *job, staged_files *written)
{
    enum { SOON_DONE = 8 };
    progress p;
    relight_job watched = *job;
    size_t count = relight_count(job);
    progress_begin(&p, "relighting", "pictures", 0, count, r->quiet || count <= SOON_DONE);
    watched.progress = &p;
    status s = relight_output(&watched, written);
    progress_end(&p);
    return s;
}

static status relight(const request *r, const char *weights, const char *output)
{
    double began = clock_seconds();
    staged_files written = {0};
    relight_job job = {.output = output,
                       .inputs = (const char *const[STAGING_MOST_INPUTS]){r->input, r->mask, r->env, r->list},
                       .lights = r->lights,
                       .how = r->how,
                       .dome = r->dome,
                       .lp = r->lp,
                       .orbit = r->orbit,
                       .frame = r->frame,
                       .stop = cli_interrupted};
    merlin_maps maps = {0};
    merlin_environment *environment = NULL;
    status s = OK;
    if (r->env) s = (status)merlin_environment_read(r->env, r->rotate, r->env_exposure, &environment);
    job.environment = environment;
    if (s == OK) s = (status)merlin_model_open(weights, &job.model);
    if (s == OK) s = get_maps(r, job.model, &maps);
    job.maps = &maps;
    if (s == OK) s = write_all(r, &job, &written);
    if (s == OK) s = announce(r, &job, &written, clock_seconds() - began);
    staged_files_free(&written);
    merlin_maps_free(&maps);
    merlin_model_close(job.model);
    merlin_environment_free(environment);
    return s == ERROR_STOPPED ? fail(s, "interrupted; nothing was written to %s", output) : s;
}

static status run(request *r)
{
    char *weights = NULL, *output = photo_output_inside(r->input, "relit", r->output);
    status s = output ? read_lights(r) : fail(ERROR_MEMORY, "no memory for a file name");
    if (s == OK && !file_exists(r->input)) s = fail(ERROR_INPUT, "there is no photograph or folder %s", r->input);
    if (s == OK) s = check_lights(r);
    if (s == OK) s = photo_find_model(r->weights, &weights);
    if (s == OK) s = relight(r, weights, output);
    free(weights);
    free(output);
    return s;
}

int cmd_relight(int argc, char **argv)
{
    request r = {.params = merlin_params_default()};
    r.params.stop = cli_interrupted;
    int code = 0;
    if (parse(&argc, &argv, &r) != OK) {
        code = cli_usage("relight", "%s", status_message());
    } else if (r.help) {
        fputs(help, stdout);
    } else {
        cli_catch_interrupts();
        status s = run(&r);
        if (s != OK) code = cli_fail("relight", s);
    }
    light_list_free(&r.lights);
    return code;
}
