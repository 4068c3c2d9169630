/* merlin render: training data. */
#include <getopt.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/parallel.h"
#include "cli/cli.h"
#include "render/generate.h"

static const char help[] =
    "Usage: merlin render --count N -o DIR [options]\n"
    "Renders training samples: objects with their maps, under a flash at the camera (direct and indirect light apart)\n"
    "and under an environment. A run that was interrupted is continued by the same command.\n"
    "\n"
    "  --count N       how many samples (required)\n"
    "  -o, --output D  folder for the samples, 000000.exr and on (required)\n"
    "  --seed S        seed of the data set (default 1)\n"
    "  --first I       index of the first sample (default 0)\n"
    "  --size P        pixels on a side (default 128)\n"
    "  --fov DEG       horizontal field of view (default 60)\n"
    "  --mesh F        this OBJ, PLY or glTF object, with procedural materials, instead of procedural shapes\n"
    "  --env-dir D     environment maps from this folder instead of procedural ones\n"
    "  --material-dir D  photographed materials (albedo, normal, roughness maps that tile) on most objects\n"
    "  --no-env        no environment image\n"
    "  --targets K     also K images under random lights in front, with cast shadows\n"
    "  --bounces       also keep bounce 2 and bounce 3 apart\n"
    "  --spp N         camera rays a pixel: 1, 4, 16, 36 or 64 (default 16)\n"
    "  --paths N       indirect paths a pixel (default 8); environment light takes five for every eight\n"
    "  --threads T     threads (default: all processors)\n"
    "  --quiet         no progress bar\n"
    "  --json          a report as JSON on stdout\n"
    "  --help          this text\n";

typedef struct request {
    render_options options;
    bool json, help;
    long threads;
} request;

static status take_number(int option, const char *text, request *r)
{
    long value = 0;
    double fov;
    status s = OK;
    image_settings *image = &r->options.image;
    switch (option) {
    case 'n':
        s = cli_int("--count", text, 1, 100000000, &value);
        r->options.count = (size_t)value;
        return s;
    case 's':
        s = cli_int("--seed", text, 0, 0x7fffffffffffffff, &value);
        r->options.seed = (uint64_t)value;
        return s;
    case 'f':
        s = cli_int("--first", text, 0, 1000000000, &value);
        r->options.first = (uint64_t)value;
        return s;
    case 'p':
        s = cli_int("--size", text, 8, 4096, &value);
        image->size = (int)value;
        return s;
    case 'v':
        s = cli_float("--fov", text, 5, 120, &fov);
        if (s == OK) image->fov = (float)fov;
        return s;
    case 'k':
        s = cli_int("--targets", text, 0, SAMPLE_MAX_TARGETS, &value);
        image->targets = (int)value;
        return s;
    case 'r':
        s = cli_int("--spp", text, 1, VISIBILITY_MAX_STRATA * VISIBILITY_MAX_STRATA, &value);
        image->strata = (int)lround(sqrt((double)value));
        if (s == OK && (image->strata * image->strata != value || (value > 1 && image->strata % 2)))
            return fail(ERROR_USAGE, "--spp must be 1, 4, 16, 36 or 64, not %s", text);
        return s;
    case 'a':
        s = cli_int("--paths", text, 1, 4096, &value);
        image->paths = (int)value;
        return s;
    default:
        return cli_int("--threads", text, 1, 1024, &r->threads);
    }
}

static status take_option(int option, const char *text, request *r)
{
    switch (option) {
    case 'o':
        r->options.folder = text;
        return OK;
    case 'm':
        r->options.mesh = text;
        return OK;
    case 'd':
        r->options.environment_folder = text;
        return OK;
    case 'w':
        r->options.material_folder = text;
        return OK;
    case 'e':
        r->options.environment = false;
        return OK;
    case 'b':
        r->options.image.bounces = true;
        return OK;
    case 'q':
        r->options.quiet = true;
        return OK;
    case 'j':
        r->json = true;
        return OK;
    case 'h':
        r->help = true;
        return OK;
    case '?':
        return fail(ERROR_USAGE, "unknown option, or its value is missing");
    default:
        return take_number(option, text, r);
    }
}

static status parse(int argc, char **argv, request *r)
{
    static const struct option options[] = {
        {"count", required_argument, NULL, 'n'},
        {"output", required_argument, NULL, 'o'},
        {"seed", required_argument, NULL, 's'},
        {"first", required_argument, NULL, 'f'},
        {"size", required_argument, NULL, 'p'},
        {"fov", required_argument, NULL, 'v'},
        {"mesh", required_argument, NULL, 'm'},
        {"env-dir", required_argument, NULL, 'd'},
        {"material-dir", required_argument, NULL, 'w'},
        {"no-env", no_argument, NULL, 'e'},
        {"targets", required_argument, NULL, 'k'},
        {"bounces", no_argument, NULL, 'b'},
        {"spp", required_argument, NULL, 'r'},
        {"paths", required_argument, NULL, 'a'},
        {"threads", required_argument, NULL, 't'},
        {"quiet", no_argument, NULL, 'q'},
        {"json", no_argument, NULL, 'j'},
        {"help", no_argument, NULL, 'h'},
        {0},
    };
    int option;
    opterr = 0;
    optind = 1;
    while ((option = getopt_long(argc, argv, "o:h", options, NULL)) != -1) {
        status s = take_option(option, optarg, r);
        if (s != OK || r->help) return s;
    }
    if (optind < argc) return fail(ERROR_USAGE, "unexpected argument %s", argv[optind]);
    if (r->options.count == 0) return fail(ERROR_USAGE, "--count is required");
    if (!r->options.folder) return fail(ERROR_USAGE, "an output folder is required: -o DIR");
    if (!r->options.environment && r->options.environment_folder)
        return fail(ERROR_USAGE, "--env-dir and --no-env contradict each other");
    return OK;
}

static void report(const request *r, const render_stats *stats)
{
    double seconds = stats->seconds > 0 ? stats->seconds : 1e-9;
    double samples = (double)stats->rendered / seconds, rays = (double)stats->rays / seconds;
    if (r->json)
        printf("{\"rendered\": %zu, \"kept\": %zu, \"seconds\": %.3f, \"samples_per_second\": %.3f, \"rays\": %llu, "
               "\"rays_per_second\": %.0f}\n",
               stats->rendered, stats->kept, stats->seconds, samples, (unsigned long long)stats->rays, rays);
    else if (!r->options.quiet)
        printf("%zu rendered, %zu kept, %.1f s: %.2f samples/s, %.2f million rays/s\n", stats->rendered, stats->kept,
               stats->seconds, samples, rays / 1e6);
}

int cmd_render(int argc, char **argv)
{
    request r = {.options = render_options_default()};
    r.options.seed = 1;
    r.options.interrupted = cli_interrupted;
    if (parse(argc, argv, &r) != OK) return cli_usage("render", "%s", status_message());
    if (r.help) {
        fputs(help, stdout);
        return 0;
    }
    if (r.threads > 0) parallel_set_threads((int)r.threads);
    cli_catch_interrupts();
    render_stats stats;
    status s = render_samples(&r.options, &stats);
    if (s != OK) return cli_fail("render", s);
    report(&r, &stats);
    return 0;
}
