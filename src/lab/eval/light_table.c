/* SPDX-License-Identifier: MIT */
#include "lab/eval/light_table.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/progress.h"
#include "estimate/light/found_light.h"
#include "estimate/photo/input.h"
#include "estimate/photo/light_choice.h"
#include "estimate/surface/exposure.h"
#include "image/color.h"
#include "lab/eval/maps.h"
#include "lab/eval/metrics.h"

const float light_angles[LIGHT_LAMPS - 1] = {10, 25, 40, 55};

/* The 95th percentile of the object's luminance, as a share of white: what a camera's automatic exposure makes of it.
 */
static const float EXPOSED = 0.7f, BRIGHT_SHARE = 0.95f;

/* What lights one photograph, and how much of each there is. */
typedef struct mixture {
    float flash, room;
    int lamp; /* -1: none */
} mixture;

typedef struct directions {
    double *angle;
    size_t count, room;
} directions;

typedef struct run {
    const light_options *options;
    network *network, *flash; /* flash: NULL, or for what `network` sees as a flash alone */
    light_table *table;
    directions found[LIGHT_KINDS];
} run;

/* One sample on its way through. */
typedef struct subject {
    const sample *s;
    img mask;
    eval_maps truth;
} subject;

static float angle_of(const sample_lamp *l)
{
    vec3 way = l->distant ? l->at : vec3_sub(l->at, vec3_make(0, 0, -1));
    return acosf(fminf(fmaxf(vec3_normalize(way).z, -1), 1)) / CAMERA_RADIAN;
}

static light_kind kind_of_lamp(const sample_lamp *l)
{
    int class = 0;
    while (class < LIGHT_LAMPS - 1 && angle_of(l) > light_angles[class])
        class ++;
    return (light_kind)(LIGHT_LAMP + class);
}

/* ---- the photograph ---- */

static float mean_luminance(const subject *on, const img *a, const img *b)
{
    double sum = 0, count = 1e-6;
    for (size_t i = 0; i < img_value_count(&on->mask); i++) {
        if (on->mask.data[i] == 0) continue;
        sum += (double)(color_luminance(a->data + 3 * i) + (b ? color_luminance(b->data + 3 * i) : 0));
        count++;
    }
    return (float)(sum / count);
}

static void add(const subject *on, const img *layer, float weight, img *to)
{
    for (size_t i = 0; i < img_value_count(to); i++)
        if (on->mask.data[i / 3] > 0) to->data[i] += weight * layer->data[i];
}

static int by_size(const void *a, const void *b)
{
    float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

static status bright_part(const subject *on, const img *photo, float *out)
{
    size_t count = 0, pixels = img_value_count(&on->mask);
    float *values = malloc((pixels + 1) * sizeof *values);
    if (!values) return fail(MERLIN_NO_MEMORY, "no memory for a photograph's brightness");
    for (size_t i = 0; i < pixels; i++)
        if (on->mask.data[i] > 0) values[count++] = color_luminance(photo->data + 3 * i);
    qsort(values, count, sizeof *values, by_size);
    *out = count ? values[(size_t)(BRIGHT_SHARE * (float)(count - 1))] : 0;
    free(values);
    return OK;
}

/* A flash alone is exposed as the samples are, everything else by its bright part; 1 is where it saturates. */
static status expose(const subject *on, const mixture *m, img *photo)
{
    float bright = 0, gain = 1 / EXPOSURE_WHITE;
    status s = bright_part(on, photo, &bright);
    if (m->room > 0 || m->lamp >= 0) gain = bright > 0 ? EXPOSED / bright : 1;
    for (size_t i = 0; i < img_value_count(photo); i++)
        photo->data[i] = fminf(gain * photo->data[i], 1);
    return s;
}

static status photograph(const subject *on, const mixture *m, img *out)
{
    const sample *s = on->s;
    float flash = mean_luminance(on, &s->direct, &s->indirect), room = mean_luminance(on, &s->env, NULL), main = flash;
    status st = img_new(out, s->mask.width, s->mask.height, 3);
    if (st != OK) return st;
    if (m->flash > 0) add(on, &s->direct, m->flash, out), add(on, &s->indirect, m->flash, out);
    if (m->lamp >= 0) {
        const sample_lamp *l = &s->lamps[m->lamp];
        add(on, &l->direct, 1, out), add(on, &l->indirect, 1, out);
        main = mean_luminance(on, &l->direct, &l->indirect);
    }
    if (m->room > 0) add(on, &s->env, room > 0 ? m->room * main / room : 0, out);
    st = expose(on, m, out);
    if (st != OK) img_free(out);
    return st;
}

/* ---- figures ---- */

static double albedo_free(const eval_maps *maps, const subject *on)
{
    double both = 0, own = 0, sum = 0, count = 1e-9;
    const float *a = maps->albedo.data, *b = on->truth.albedo.data;
    for (size_t i = 0; i < img_value_count(&maps->albedo); i++) {
        if (on->mask.data[i / 3] == 0) continue;
        double x = 0.5 * (double)a[i] + 0.5, y = 0.5 * (double)b[i] + 0.5;
        both += x * y;
        own += x * x;
    }
    const double scale = own > 0 ? both / own : 1;
    for (size_t i = 0; i < img_value_count(&maps->albedo); i++) {
        if (on->mask.data[i / 3] == 0) continue;
        double x = 0.5 * (double)a[i] + 0.5, y = 0.5 * (double)b[i] + 0.5, e = 2 * (scale * x - y);
        sum += e * e;
        count++;
    }
    return sum / count;
}

static double relief_error(const img *depth, const subject *on)
{
    double sum = 0, squares = 0, count = 1e-9;
    for (size_t i = 0; i < img_value_count(depth); i++) {
        if (on->mask.data[i] == 0) continue;
        double e = (double)(depth->data[i] - on->truth.depth.data[i]);
        sum += e;
        squares += e * e;
        count++;
    }
    double mean = sum / count, width = 2 * (double)camera_tangent(on->s->fov);
    return sqrt(fmax(squares / count - mean * mean, 0)) / width;
}

static status note_direction(directions *to, double degrees)
{
    if (to->count == to->room) {
        size_t room = 2 * to->room + 64;
        double *grown = realloc(to->angle, room * sizeof *grown);
        if (!grown) return fail(MERLIN_NO_MEMORY, "no memory for directions");
        to->angle = grown;
        to->room = room;
    }
    to->angle[to->count++] = degrees;
    return OK;
}

static status judge_direction(run *r, const subject *on, const mixture *m, light_kind kind, const float *lights)
{
    const sample_lamp *l = &on->s->lamps[m->lamp];
    vec3 way = vec3_normalize(l->distant ? l->at : vec3_sub(l->at, vec3_make(0, 0, -1)));
    vec3 found = vec3_of(lights + MODEL_LIGHTS_LAMP);
    double cosine = (double)vec3_dot(way, found) / fmax((double)vec3_length(found), 1e-9);
    return note_direction(&r->found[kind], acos(fmin(fmax(cosine, -1), 1)) / (double)CAMERA_RADIAN);
}

static void add_figures(const network_estimation *e, const subject *on, double sum[LIGHT_FIGURES])
{
    const eval_maps maps = {e->maps.albedo, e->maps.normal, e->maps.roughness, e->maps.depth};
    sum[LIGHT_ANGLE] += eval_angle(&maps.normal, &on->truth.normal, &on->mask);
    sum[LIGHT_ALBEDO] += eval_mse(&maps.albedo, &on->truth.albedo, &on->mask);
    sum[LIGHT_ALBEDO_FREE] += albedo_free(&maps, on);
    sum[LIGHT_ROUGHNESS] += eval_mse(&maps.roughness, &on->truth.roughness, &on->mask);
    sum[LIGHT_RELIEF] += relief_error(&maps.depth, on);
}

static bool is_flash(const float *lights)
{
    merlin_found_light light;
    found_light_take(lights, &light);
    return found_light_is_flash(&light);
}

static status measure(run *r, const subject *on, const mixture *m, light_kind kind)
{
    sight how = {.lens = {on->s->fov, on->s->slant}};
    if (r->options->lens_unknown) how.lens.fov = 0;
    network_estimation e = {0};
    network *n = NULL;
    img photo = {0};
    status s = photograph(on, m, &photo);
    if (s == OK) input_expose(&photo, exposure_gain(&photo, &on->mask));
    const light_question asked = {&photo, &on->mask, &how, MERLIN_FLASH_UNKNOWN};
    if (s == OK) s = light_choice(r->network, r->flash, &asked, &n);
    if (s == OK) s = network_estimate(n, &photo, &on->mask, &how, r->options->views, NULL, &e);
    if (s == OK && m->lamp >= 0 && r->table->directions) s = judge_direction(r, on, m, kind, e.lights);
    if (s == OK) {
        eval_to_network_range(&e.maps.albedo);
        eval_to_network_range(&e.maps.roughness);
        add_figures(&e, on, r->table->mean[kind]);
        r->table->mean[kind][LIGHT_AS_FLASH] += r->flash ? n == r->flash : is_flash(e.lights);
        r->table->count[kind]++;
    }
    network_estimation_free(&e);
    img_free(&photo);
    return s;
}

static status measure_sample(run *r, const sample *s)
{
    subject on = {.s = s};
    status st = eval_binary_mask(&s->mask, &on.mask);
    if (st == OK) st = eval_maps_of_sample(s, &on.truth);
    if (st == OK) st = measure(r, &on, &(mixture){1, 0, -1}, LIGHT_FLASH);
    if (st == OK) st = measure(r, &on, &(mixture){1, 0.5f, -1}, LIGHT_FLASH_IN_ROOM);
    if (st == OK) st = measure(r, &on, &(mixture){0, 1, -1}, LIGHT_ROOM);
    for (int i = 0; i < s->lamp_count && st == OK; i++)
        st = measure(r, &on, &(mixture){0, 0, i}, kind_of_lamp(&s->lamps[i]));
    if (st == OK) st = measure(r, &on, &(mixture){0, 0.5f, 0}, LIGHT_LAMP_IN_ROOM);
    img_free(&on.mask);
    eval_maps_free(&on.truth);
    return st;
}

static status measure_file(run *r, const char *path)
{
    sample s;
    status st = sample_read(path, &s);
    if (st != OK) return st;
    int side = s.mask.width;
    if (s.lamp_count == 0 || !s.env.data)
        st = fail(MERLIN_BAD_INPUT, "%s was rendered without lamps or without environment: render samples with --lamps",
                  path);
    else if (side != s.mask.height || side % MODEL_SIZE_MULTIPLE || side > NETWORK_SIZE)
        st = fail(MERLIN_BAD_INPUT, "%s is %dx%d pixels; squares of a multiple of %d up to %d are evaluated", path,
                  side, s.mask.height, MODEL_SIZE_MULTIPLE, NETWORK_SIZE);
    if (st == OK) st = measure_sample(r, &s);
    if (st == OK) r->table->samples++;
    sample_free(&s);
    return st;
}

static void finish(run *r)
{
    light_table *t = r->table;
    for (int kind = 0; kind < LIGHT_KINDS; kind++) {
        directions *d = &r->found[kind];
        for (int f = 0; f < LIGHT_FIGURES; f++)
            t->mean[kind][f] = t->count[kind] ? t->mean[kind][f] / (double)t->count[kind] : (double)NAN;
        t->mean[kind][LIGHT_DIRECTION] = eval_median(d->angle, d->count);
        free(d->angle);
    }
}

static status measure_files(run *r, char **names, size_t count)
{
    progress p;
    status s = OK;
    progress_begin(&p, "evaluating", "samples", 0, count, r->options->quiet);
    for (size_t i = 0; i < count && s == OK; i++) {
        if (r->options->stopped && r->options->stopped())
            s = fail(MERLIN_STOPPED, "stopped after %zu of %zu samples", i, count);
        else
            s = measure_file(r, names[i]);
        if (s == OK) progress_update(&p, i + 1, NULL);
    }
    progress_end(&p);
    finish(r);
    return s;
}

status light_table_run(const light_options *options, light_table *out)
{
    *out = (light_table){.samples = 0};
    double began = clock_seconds();
    run r = {.options = options, .table = out};
    char **names;
    size_t count;
    status s = sample_list(options->data, &names, &count);
    if (s != OK) return s;
    s = network_open(options->weights, &r.network);
    if (s == OK && options->flash) s = network_open(options->flash, &r.flash);
    if (s == OK) {
        const model_config *config = network_config(r.network);
        size_t used = options->count && options->count < count ? options->count : count;
        memcpy(out->model, config->name, sizeof out->model);
        if (r.flash) memcpy(out->flash_model, network_config(r.flash)->name, sizeof out->flash_model);
        out->directions = config->lighting == MODEL_LIGHT_ANY;
        s = measure_files(&r, names, used);
    }
    network_close(r.flash);
    network_close(r.network);
    file_list_free(names, count);
    out->seconds = clock_seconds() - began;
    return s;
}
