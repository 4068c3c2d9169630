/* merlin relight: the object of a photograph under other light. */
#include <getopt.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/light_list.h"
#include "base/progress.h"
#include "cli/cli.h"
#include "cli/photos.h"
#include "cli/relight_output.h"

static const char help[] =
    "usage: merlin relight PHOTO|DIR --light x,y,z [--light ...] [options]\n"
    "       merlin relight PHOTO|DIR --lights FILE [options]\n"
    "       merlin relight PHOTO|DIR --orbit N [options]\n"
    "       merlin relight PHOTO|DIR --dome N [--lp] [options]\n"
    "       merlin relight PHOTO|DIR --env FILE [--rotate DEG] [--light x,y,z] [--orbit N] [options]\n\n"
    "Shows an object under a point light, an environment, or both instead of the flash. DIR is a folder made by merlin "
    "estimate; a PHOTO is\n"
    "estimated first. The camera is at 0,0,0 and looks along -z, x right, y up; the object is near 0,0,-1; the crop\n"
    "around the object counts as a frame 60 degrees wide.\n\n"
    "      --light x,y,z    a light's position; may be given again\n"
    "      --lights FILE    positions from a file: x y z a line, or the directions of an .lp file\n"
    "      --orbit N        N frames with the light on a circle in front of the object, also as orbit.webp and "
    "orbit.gif\n"
    "      --dome N         N pictures, dome_000.png and on, under lights spread evenly over the frontal hemisphere, "
    "and "
    "mask.png\n"
    "      --lp             with --dome: dome.lp, the light list of RTI tools and of merlin stereo\n"
    "      --env FILE       surroundings from a latitude-longitude picture (.hdr, .exr), alone or beside each light\n"
    "      --rotate DEG     turns them about the vertical: at 90 what was straight ahead is to the right\n"
    "      --env-exposure EV\n"
    "                       makes them brighter or darker (default 0: mean luminance 1)\n"
    "                       with --orbit they go round once, and the light stays\n"
    "      --by WAY         brdf (default): the maps' BRDF with cast shadows and the network's global illumination;\n"
    "                       network: the relighting decoder, made for lights at distance 1 from 0,0,-1 with z >= -1\n"
    "      --no-shadows     brdf without cast shadows, as in the paper\n"
    "  -o, --output DIR     where to (default: relit inside DIR, or inside the photograph's name + .merlin)\n"
    "      --frame N        side of the orbit's frames (default: the crop's, at most 512)\n"
    "      --mask FILE, --size N, --exposure EV\n"
    "                       for a PHOTO, as in merlin estimate\n"
    "      --model FILE     weights (default: $MERLIN_MODEL, else the shipped models/merlin-point.safetensors)\n"
    "      --json           a report as JSON on standard output\n"
    "      --quiet          no other output than errors\n"
    "  -h, --help           this text\n\n"
    "Writes relit_000.png and on, and relit.png with all of them; for an orbit frame_000.png and on, and orbit.png.\n";

enum {
    OPTION_LIGHT = 256,
    OPTION_LIGHTS,
    OPTION_ORBIT,
    OPTION_DOME,
    OPTION_LP,
    OPTION_ENV,
    OPTION_ROTATE,
    OPTION_ENV_EXPOSURE,
    OPTION_BY,
    OPTION_NO_SHADOWS,
    OPTION_FRAME,
    OPTION_MASK,
    OPTION_SIZE,
    OPTION_EXPOSURE,
    OPTION_MODEL,
    OPTION_JSON,
    OPTION_QUIET
};

static const struct option long_options[] = {
    {"light", required_argument, NULL, OPTION_LIGHT},
    {"lights", required_argument, NULL, OPTION_LIGHTS},
    {"orbit", required_argument, NULL, OPTION_ORBIT},
    {"dome", required_argument, NULL, OPTION_DOME},
    {"lp", no_argument, NULL, OPTION_LP},
    {"env", required_argument, NULL, OPTION_ENV},
    {"rotate", required_argument, NULL, OPTION_ROTATE},
    {"env-exposure", required_argument, NULL, OPTION_ENV_EXPOSURE},
    {"by", required_argument, NULL, OPTION_BY},
    {"no-shadows", no_argument, NULL, OPTION_NO_SHADOWS},
    {"frame", required_argument, NULL, OPTION_FRAME},
    {"mask", required_argument, NULL, OPTION_MASK},
    {"size", required_argument, NULL, OPTION_SIZE},
    {"exposure", required_argument, NULL, OPTION_EXPOSURE},
    {"model", required_argument, NULL, OPTION_MODEL},
    {"output", required_argument, NULL, 'o'},
    {"json", no_argument, NULL, OPTION_JSON},
    {"quiet", no_argument, NULL, OPTION_QUIET},
    {"help", no_argument, NULL, 'h'},
    {0},
};

typedef struct request {
    const char *input, *list, *mask, *weights, *output, *env;
    double rotate, env_exposure;
    light_list lights;
    merlin_params params;
    merlin_relighting how;
    long orbit, frame, dome;
    bool lp, no_shadows, json, quiet, help;
} request;

static status take_light(const char *text, light_list *lights)
{
    float v[3];
    status s = cli_vec3("--light", text, v);
    return s == OK ? light_list_add(lights, vec3_make(v[0], v[1], v[2])) : s;
}

static status take_way(const char *text, merlin_relighting *how)
{
    if (strcmp(text, "brdf") == 0)
        *how = MERLIN_BY_BRDF;
    else if (strcmp(text, "network") == 0)
        *how = MERLIN_BY_NETWORK;
    else
        return fail(ERROR_USAGE, "--by wants brdf or network, not \"%s\"", text);
    return OK;
}

static status take_text(int option, const char *value, request *r)
{
    switch (option) {
    case OPTION_LIGHTS:
        r->list = value;
        return OK;
    case OPTION_ENV:
        r->env = value;
        return OK;
    case OPTION_MASK:
        r->mask = value;
        return OK;
    case OPTION_MODEL:
        r->weights = value;
        return OK;
    case 'o':
        r->output = value;
        return OK;
    case OPTION_LP:
        r->lp = true;
        return OK;
    case OPTION_NO_SHADOWS:
        r->no_shadows = true;
        return OK;
    case OPTION_JSON:
        r->json = true;
        return OK;
    case OPTION_QUIET:
        r->quiet = true;
        return OK;
    case 'h':
        r->help = true;
        return OK;
    default:
        return fail(ERROR_USAGE, "unknown option, or its value is missing");
    }
}

static status take_option(int option, const char *value, request *r)
{
    switch (option) {
    case OPTION_LIGHT:
        return take_light(value, &r->lights);
    case OPTION_ORBIT:
        return cli_int("--orbit", value, 2, RELIGHT_MOST_FRAMES, &r->orbit);
    case OPTION_DOME:
        return cli_int("--dome", value, 3, RELIGHT_MOST_DOME, &r->dome);
    case OPTION_FRAME:
        return cli_int("--frame", value, 32, 1024, &r->frame);
    case OPTION_ROTATE:
        return cli_float("--rotate", value, -1e6, 1e6, &r->rotate);
    case OPTION_ENV_EXPOSURE:
        return cli_float("--env-exposure", value, -20, 20, &r->env_exposure);
    case OPTION_BY:
        return take_way(value, &r->how);
    case OPTION_SIZE:
        return photo_parse_size(value, &r->params);
    case OPTION_EXPOSURE:
        return photo_parse_exposure(value, &r->params);
    default:
        return take_text(option, value, r);
    }
}

static status parse(int argc, char **argv, request *r)
{
    int option;
    opterr = 0;
    optind = 1;
    while ((option = getopt_long(argc, argv, "o:h", long_options, NULL)) != -1) {
        status s = take_option(option, optarg, r);
        if (s != OK || r->help) return s;
    }
    if (optind == argc) return fail(ERROR_USAGE, "no photograph or folder given");
    if (optind + 1 < argc)
        return fail(ERROR_USAGE, "one photograph or folder at a time, not also %s", argv[optind + 1]);
    r->input = argv[optind];
    if (r->lights.count == 0 && !r->list && r->orbit == 0 && r->dome == 0 && !r->env)
        return fail(ERROR_USAGE, "no light: give --light, --lights, --orbit, --dome or --env");
    if (!r->env && (r->rotate != 0 || r->env_exposure != 0))
        return fail(ERROR_USAGE, "--rotate and --env-exposure want an --env");
    if (r->env && r->dome) return fail(ERROR_USAGE, "--dome is of point lights alone, without --env");
    if (r->no_shadows && r->how == MERLIN_BY_BRDF) r->how = MERLIN_BY_BRDF_UNSHADOWED;
    if (r->lp && r->dome == 0) return fail(ERROR_USAGE, "--lp lists the lights of a --dome");
    return OK;
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

/* From a folder of estimate's, or by estimating now. */
static status get_maps(const request *r, merlin_model *model, merlin_maps *maps)
{
    *maps = (merlin_maps){0};
    if (file_is_folder(r->input)) return (status)merlin_maps_read(r->input, maps);
    merlin_image photo = {0}, mask = {0};
    photo_job job = {.photo = (char *)r->input, .mask = (char *)r->mask};
    status s = photo_read(&job, &photo, &mask);
    if (s == OK) {
        s = (status)merlin_estimate(model, &photo, &mask, &r->params, maps);
        if (s != OK) s = fail_in(s, "%s", r->input);
    }
    merlin_image_free(&photo);
    merlin_image_free(&mask);
    return s;
}

static char *choose_output(const request *r)
{
    if (r->output) return strdup(r->output);
    char *base = file_is_folder(r->input) ? strdup(r->input) : photo_default_output(r->input);
    char *out = base ? file_join(base, "relit") : NULL;
    free(base);
    return out;
}

static void announce(const request *r, const relight_job *job, double seconds)
{
    if (r->json)
        printf("{\"lights\": %zu, \"orbit\": %d, \"dome\": %d, \"by\": \"%s\", \"model\": \"%s\", \"seconds_total\": "
               "%.4f}\n",
               job->lights.count, job->orbit, job->dome, r->how == MERLIN_BY_NETWORK ? "network" : "brdf",
               merlin_model_name(job->model), seconds);
    else if (!r->quiet)
        printf("%s: %s (%.2f s)\n", r->input, job->output, seconds);
}

static status relight(const request *r, const char *weights, const char *output)
{
    double began = clock_seconds();
    relight_job job = {.output = output,
                       .lights = r->lights,
                       .how = r->how,
                       .dome = (int)r->dome,
                       .lp = r->lp,
                       .orbit = (int)r->orbit,
                       .frame = (int)r->frame,
                       .stop = cli_interrupted};
    merlin_maps maps = {0};
    merlin_environment *environment = NULL;
    status s = OK;
    if (r->env) s = (status)merlin_environment_read(r->env, (float)r->rotate, (float)r->env_exposure, &environment);
    job.environment = environment;
    if (s == OK) s = (status)merlin_model_open(weights, &job.model);
    if (s == OK) s = get_maps(r, job.model, &maps);
    job.maps = &maps;
    if (s == OK) s = relight_output(&job);
    if (s == OK) announce(r, &job, clock_seconds() - began);
    merlin_maps_free(&maps);
    merlin_model_close(job.model);
    merlin_environment_free(environment);
    return s == ERROR_STOPPED ? fail(s, "interrupted; nothing was written to %s", output) : s;
}

static status run(request *r)
{
    char *weights = NULL, *output = choose_output(r);
    status s = output ? read_lights(r) : fail(ERROR_MEMORY, "no memory for a file name");
    if (s == OK && !file_exists(r->input)) s = fail(ERROR_INPUT, "there is no photograph or folder %s", r->input);
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
    if (parse(argc, argv, &r) != OK) {
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
