/* SPDX-License-Identifier: MIT */
#include "lab/render/generate.h"

#include <inttypes.h>
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/parallel.h"
#include "base/progress.h"
#include "lab/render/contents.h"
#include "lab/render/streams.h"
#include "lab/scene/material/texture.h"
#include "lab/scene/object/model_folder.h"
#include "optics/camera.h"

/* State shared by all threads of a run. `failed` and everything below it change only inside the critical section. */
typedef struct run {
    const render_options *options;
    trace_device *device;
    environment_folder maps;
    scene_textures textures;
    scene_model *model;  /* NULL: procedural objects, or `models` */
    scene_models models; /* for a share of the objects */
    render_stats *stats;
    progress bar;
    status failed;
    char message[512];
} run;

/* Returns the command's defaults; docs/notes/paths.md measures eight paths. */
render_options render_options_default(void)
{
    return (render_options){.image = {.size = 128, .fov = CAMERA_FOV, .strata = 4, .paths = 8}, .environment = true};
}

static status make_environment(const run *r, uint64_t index, environment *out)
{
    *out = (environment){0};
    if (!r->options->environment) return OK;
    rng generator = rng_at(r->options->seed, index, STREAM_ENVIRONMENT);
    if (r->maps.count == 0) return environment_procedural(&generator, out);
    int chosen = rng_below(&generator, (int)r->maps.count);
    return environment_from_map(&r->maps.maps[chosen], &generator, out);
}

/* Half of the field of view of a whole photograph, corner to corner, for the widest lens, in degrees: crops stay
 * inside. */
static const float HALF_FRAME = 40;

/* Returns the settings with the lens of one sample. */
static image_settings lens_of(const render_options *o, uint64_t index)
{
    image_settings image = o->image;
    rng r = rng_at(o->seed, index, STREAM_LENS);
    float wide = rng_uniform(&r), far = rng_uniform(&r), angle = 2 * PI * rng_uniform(&r);
    if (o->widest_fov > 0) image.fov *= powf(o->widest_fov / image.fov, wide);
    float most = fminf(o->off_axis, fmaxf(HALF_FRAME - image.fov / 2, 0));
    if (most > 0) image.slant = camera_tilt(far * most * cosf(angle), far * most * sinf(angle));
    return image;
}

static status make_object(const run *r, uint64_t index, float fov, scene_object *out)
{
    const render_options *o = r->options;
    const float share = o->mesh_share > 0 ? o->mesh_share : 0.5f;
    status s;
    if (r->model)
        s = scene_object_from_model(r->model, o->seed, index, fov, out);
    else if (r->models.count && scene_models_chosen(o->seed, index, share))
        s = scene_object_from_models(&r->models, o->seed, index, fov, out);
    else
        s = scene_object_generate(o->seed, index, fov, out);
    if (s == OK && r->textures.count) scene_object_apply_textures(out, &r->textures, o->seed, index);
    return s;
}

/* Returns the expected number of rays: about half of the pixels see the object. */
static double expected_rays(const render_options *o)
{
    const image_settings *m = &o->image;
    double layers = 1 + m->targets + m->leds + m->lamps + o->environment;
    return (double)m->size * m->size * (m->strata + 0.5 * m->paths * layers);
}

/* Renders a sample; env: empty, or the environment of its environment image. */
static status make_sample_under(const run *r, uint64_t index, const environment *env, sample *out, uint64_t *rays)
{
    const render_options *o = r->options;
    scene_object object;
    trace_scene scene = {0};
    const image_settings image = lens_of(o, index);
    status s = make_object(r, index, image.fov, &object);
    if (s != OK) return s;
    s = trace_scene_new(r->device, &object, scene_surfaces_eval, expected_rays(o), &scene);
    if (s == OK) s = render_image(&scene, &image, o->seed, index, env->map.data ? env : NULL, out);
    *rays = scene.rays;
    trace_scene_free(&scene);
    scene_object_free(&object);
    return s;
}

static status make_sample(const run *r, uint64_t index, sample *out, uint64_t *rays)
{
    environment env;
    status s = make_environment(r, index, &env);
    if (s == OK) s = make_sample_under(r, index, &env, out, rays);
    environment_free(&env);
    return s;
}

/* Renders one sample and writes it, unless it exists already. */
static status produce(const run *r, uint64_t index, bool *kept, uint64_t *rays)
{
    sample s = {0};
    char *path = NULL;
    status st = OK;
    if (r->options->folder) {
        path = sample_path(r->options->folder, index);
        if (!path) return fail(MERLIN_NO_MEMORY, "out of memory");
        *kept = file_exists(path);
    }
    if (!*kept) {
        st = make_sample(r, index, &s, rays);
        if (st == OK && path) st = sample_write(path, &s);
        sample_free(&s);
        if (st != OK) fail_in(st, "sample %" PRIu64, index);
    }
    free(path);
    return st;
}

static void note_result(run *r, status st, bool kept, uint64_t rays)
{
    if (st != OK && r->failed == OK) {
        r->failed = st;
        snprintf(r->message, sizeof r->message, "%s", status_message());
    }
    if (st != OK) return;
    r->stats->rendered += !kept;
    r->stats->kept += kept;
    r->stats->rays += rays;
    if (kept) r->bar.first++; /* took no time, so that it must not count as speed */
    progress_update(&r->bar, r->stats->rendered + r->stats->kept, NULL);
}

static void body(void *context, size_t i)
{
    run *r = context;
    bool stop, kept = false;
    uint64_t rays = 0;
#pragma omp critical(render_run)
    stop = r->failed != OK;
    if (stop) return;
    status st;
    if (r->options->interrupted && r->options->interrupted())
        st = fail(MERLIN_STOPPED, "interrupted; run the same command again to continue");
    else
        st = produce(r, r->options->first + i, &kept, &rays);
#pragma omp critical(render_run)
    note_result(r, st, kept, rays);
}

/* ---- the output folder and its description --------------------------------------------------------------------------
 */

/* Describes options that are written only if they are set, so that folders of earlier versions can be continued. */
static void describe_more(const render_options *o, char *out, size_t size)
{
    int length = 0;
    if (o->image.leds) length += snprintf(out, size, "leds %d\n", o->image.leds);
    if (o->image.lamps) length += snprintf(out + length, size - (size_t)length, "lamps %d\n", o->image.lamps);
    for (int i = 0; i < o->image.lamp_angles; i++)
        length += snprintf(out + length, size - (size_t)length, "lamp at %g\n", (double)o->image.lamp_angle[i]);
    if (o->widest_fov > 0)
        length += snprintf(out + length, size - (size_t)length, "widest fov %g\n", (double)o->widest_fov);
    if (o->off_axis > 0) length += snprintf(out + length, size - (size_t)length, "off axis %g\n", (double)o->off_axis);
    if (o->mesh_folder)
        snprintf(out + length, size - (size_t)length, "meshes %s\nmesh share %g\n", o->mesh_folder,
                 (double)o->mesh_share);
}

static void describe(const render_options *o, char *out, size_t size)
{
    const image_settings *m = &o->image;
    snprintf(out, size,
             "generator %d\nseed %" PRIu64 "\nsize %d\nfov %g\nstrata %d\npaths %d\ntargets %d\nbounces %d\n"
             "environment %s\nobjects %s\n%s%s%s",
             SAMPLE_GENERATOR_VERSION, o->seed, m->size, (double)m->fov, m->strata, m->paths, m->targets, m->bounces,
             !o->environment         ? "none"
             : o->environment_folder ? o->environment_folder
                                     : "procedural",
             o->mesh ? o->mesh : "procedural", o->material_folder ? "materials " : "",
             o->material_folder ? o->material_folder : "", o->material_folder ? "\n" : "");
    describe_more(o, out + strlen(out), size - strlen(out));
}

/* Shortens a path to its parent folder; returns false if there is none. */
static bool go_up(char *path)
{
    char *slash = strrchr(path, '/');
    if (strcmp(path, ".") == 0 || strcmp(path, "/") == 0) return false;
    if (slash)
        slash[slash == path] = 0;
    else
        memcpy(path, ".", sizeof ".");
    return true;
}

/* Tells whether a folder, which need not exist yet, is `outer` or inside it. */
static bool lies_in(const char *folder, const char *outer)
{
    char named[PATH_MAX], path[PATH_MAX];
    snprintf(named, sizeof named, "%s", folder);
    while (!file_exists(named) && go_up(named))
        ;
    if (!realpath(named, path)) return false;
    while (!file_is_same(path, outer))
        if (!go_up(path)) return false;
    return true;
}

/* Refuses to write samples into a folder that is read: the run that continues this one would read them as input. */
static status check_apart(const render_options *o)
{
    const char *materials = o->material_folder, *maps = o->environment_folder, *read = NULL;
    if (maps && file_is_same(o->folder, maps)) read = maps;
    if (materials && lies_in(o->folder, materials)) read = materials;
    if (!read) return OK;
    return fail(MERLIN_WRONG_USE, "samples in %s would be taken for pictures of %s: choose another folder", o->folder,
                read);
}

/* Compares the stored description; folders of older versions do not contain checksums, and can be continued. */
static status compare_claims(const render_options *o, const char *path, const char *options, const char *contents)
{
    char *found = NULL;
    size_t size, length = strlen(options);
    status s = file_read(path, length + 4096, &found, &size);
    if (s != OK) return s;
    if (strncmp(found, options, length) != 0 || (found[length] && strncmp(found + length, "contents ", 9) != 0))
        s = fail(MERLIN_WRONG_USE, "%s holds samples made with other options (see %s): choose another folder",
                 o->folder, path);
    else if (found[length] && strcmp(found + length, contents) != 0)
        s = fail(MERLIN_WRONG_USE,
                 "%s holds samples made of other files than are there now (see contents in %s): choose another folder",
                 o->folder, path);
    free(found);
    return s;
}

static status claim_for(const render_options *o, const char *contents)
{
    char options[8192];
    describe(o, options, sizeof options);
    char *path = file_join(o->folder, "render.txt"), *text = NULL;
    if (path && asprintf(&text, "%s%s", options, contents) < 0) text = NULL;
    status s = path && text ? OK : fail(MERLIN_NO_MEMORY, "out of memory");
    if (s == OK)
        s = file_exists(path) ? compare_claims(o, path, options, contents) : file_write(path, text, strlen(text));
    free(text);
    free(path);
    return s;
}

static status claim_folder(const render_options *o)
{
    char *contents = NULL;
    status s = check_apart(o);
    if (s == OK) s = contents_describe(o, &contents);
    if (s == OK) s = file_make_folder(o->folder);
    if (s == OK) s = claim_for(o, contents);
    free(contents);
    return s;
}

static status check_options(const render_options *o)
{
    const image_settings *m = &o->image;
    if (m->size < 1 || m->size > 4096) return fail(MERLIN_WRONG_USE, "image size %d is not within 1..4096", m->size);
    if (!(m->fov >= 1 && m->fov <= 150))
        return fail(MERLIN_WRONG_USE, "field of view %g is not within 1..150", (double)m->fov);
    if (o->widest_fov != 0 && !(o->widest_fov >= m->fov && o->widest_fov <= 150))
        return fail(MERLIN_WRONG_USE, "lenses of %g to %g degrees: the wider one belongs behind, up to 150",
                    (double)m->fov, (double)o->widest_fov);
    if (!(o->off_axis >= 0 && o->off_axis <= HALF_FRAME))
        return fail(MERLIN_WRONG_USE, "pictures %g degrees off the axis: 0 to %g", (double)o->off_axis,
                    (double)HALF_FRAME);
    if (m->lamps < 0 || m->lamps > SAMPLE_MAX_LAMPS)
        return fail(MERLIN_WRONG_USE, "%d lamps: at most %d", m->lamps, SAMPLE_MAX_LAMPS);
    if (m->strata < 1 || m->strata > VISIBILITY_MAX_STRATA || (m->strata > 1 && m->strata % 2))
        return fail(MERLIN_WRONG_USE, "%d x %d rays a pixel: must be 1, 4, 16, 36 or 64 in all", m->strata, m->strata);
    if (m->paths < 1) return fail(MERLIN_WRONG_USE, "at least one path a pixel is needed");
    if (m->targets < 0 || m->targets > SAMPLE_MAX_TARGETS)
        return fail(MERLIN_WRONG_USE, "%d targets: at most %d", m->targets, SAMPLE_MAX_TARGETS);
    if (m->leds < 0 || m->leds > SAMPLE_MAX_TARGETS - m->targets)
        return fail(MERLIN_WRONG_USE, "%d targets and %d LEDs: at most %d together", m->targets, m->leds,
                    SAMPLE_MAX_TARGETS);
    return OK;
}

static void close_run(run *r)
{
    scene_model_free(r->model);
    scene_models_free(&r->models);
    scene_textures_free(&r->textures);
    environment_folder_free(&r->maps);
    trace_device_free(r->device);
}

static status open_run(const render_options *o, run *r)
{
    *r = (run){.options = o};
    status s = check_options(o);
    if (s == OK) s = trace_device_new(&r->device);
    if (s == OK && o->environment && o->environment_folder)
        s = environment_folder_read(o->environment_folder, &r->maps);
    if (s == OK && o->material_folder) s = scene_textures_read(o->material_folder, &r->textures);
    if (s == OK && o->mesh) s = scene_model_read(o->mesh, &r->model);
    if (s == OK && o->mesh_folder) s = scene_models_read(o->mesh_folder, &r->models);
    if (s != OK) close_run(r);
    return s;
}

/* Reads the mesh before the folder is claimed for it, so that a wrong path does not block the right one. */
static status check_mesh(const run *r)
{
    scene_object object;
    if (!r->model) return OK;
    const uint64_t first = r->options->first;
    status s = make_object(r, first, lens_of(r->options, first).fov, &object);
    if (s == OK) scene_object_free(&object);
    return s;
}

void render_stats_free(render_stats *stats)
{
    skipped_free(&stats->skipped_maps);
    skipped_free(&stats->skipped_materials);
    skipped_free(&stats->skipped_meshes);
}

status render_samples(const render_options *options, render_stats *stats)
{
    run r;
    *stats = (render_stats){0};
    status s = open_run(options, &r);
    if (s != OK) return s;
    r.stats = stats;
    stats->skipped_maps = r.maps.skipped;
    stats->skipped_materials = r.textures.skipped;
    stats->skipped_meshes = r.models.skipped;
    r.maps.skipped = r.textures.skipped = r.models.skipped = (skipped_files){0};
    if (options->folder) s = check_mesh(&r);
    if (s == OK && options->folder) s = claim_folder(options);
    if (s == OK) {
        double start = clock_seconds();
        progress_begin(&r.bar, "rendering", "samples", 0, options->count, options->quiet);
        parallel_for(options->count, body, &r);
        progress_end(&r.bar);
        stats->seconds = clock_seconds() - start;
        if (r.failed != OK) s = fail(r.failed, "%s", r.message);
    }
    close_run(&r);
    return s;
}

status render_sample(const render_options *options, uint64_t index, sample *out)
{
    run r;
    uint64_t rays;
    *out = (sample){0};
    status s = open_run(options, &r);
    if (s != OK) return s;
    s = make_sample(&r, index, out, &rays);
    close_run(&r);
    return s;
}

status render_sample_elsewhere(const render_options *options, uint64_t index, uint64_t place, sample *out,
                               environment *env)
{
    run r;
    uint64_t rays;
    *out = (sample){0};
    *env = (environment){0};
    status s = open_run(options, &r);
    if (s != OK) return s;
    s = make_environment(&r, place, env);
    if (s == OK) s = make_sample_under(&r, index, env, out, &rays);
    if (s != OK) environment_free(env);
    close_run(&r);
    return s;
}
