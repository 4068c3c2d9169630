/* SPDX-License-Identifier: MIT */
#include "lab/eval/tables/several_table.h"

#include <cjson/cJSON.h>
#include <math.h>
#include <stdlib.h>

#include "base/json/json_put.h"
#include "base/number.h"
#include "base/progress.h"
#include "base/text/report.h"
#include "estimate/photo/compare.h"
#include "estimate/photo/input.h"
#include "estimate/photo/network.h"
#include "estimate/surface/exposure.h"
#include "lab/eval/samples/each_sample.h"

enum { MOST = 1 << (SEVERAL_ROWS - 1) };

typedef struct run {
    const several_options *options;
    network *network, *several; /* several: network that compares the photographs, or NULL */
    several_table *table;
} run;

/* Photographs of a sample as the network takes them. */
typedef struct photographs {
    img photo[MOST], mask;
    int count;
    sight how;
} photographs;

static void photographs_free(photographs *p)
{
    for (int i = 0; i < p->count; i++)
        img_free(&p->photo[i]);
    img_free(&p->mask);
}

/* Takes a photograph under one lamp, which exposes it as a camera does. */
static status photograph(const lit_subject *on, int number, int size, photographs *out)
{
    img radiance = {0}, *photo = &out->photo[out->count];
    float white = 1;
    img_free(&out->mask);
    status s = lit_radiance(on, &(lit_mixture){.lamp = number}, &radiance, &white);
    for (size_t i = 0; s == OK && i < img_value_count(&radiance); i++)
        radiance.data[i] = clamp(radiance.data[i] / white, 0, 1);
    if (s == OK) s = input_make(&radiance, &on->s->mask, network_side(size), photo, &out->mask);
    img_free(&radiance);
    if (s != OK) return s;
    out->count++;
    input_expose(photo, exposure_gain(photo, &out->mask));
    return OK;
}

/* Returns the angle between a lamp's direction and the one that a network sees, degrees; 90 if it sees none. */
static double lamp_error(const sample_lamp *truth, const float *lights)
{
    const vec3 way = truth->distant ? truth->at : vec3_sub(truth->at, vec3_make(0, 0, -1));
    const vec3 seen = vec3_normalize(vec3_of(lights + MODEL_LIGHTS_LAMP));
    return acos((double)clamp(vec3_dot(vec3_normalize(way), seen), -1, 1)) / DEGREE;
}

/* Adds the figures of maps, which are enlarged to the sample's size first. */
static status add_figures(const surface *maps, const lit_subject *on, double sum[LIT_FIGURES])
{
    surface whole = {0};
    if (!maps->normal.data) return OK;
    if (maps->normal.width == on->mask.width) {
        lit_figures_add(maps, on, sum);
        return OK;
    }
    status s = surface_resize(maps, &on->mask, &whole);
    if (s == OK) lit_figures_add(&whole, on, sum);
    surface_free(&whole);
    return s;
}

static status measure(const run *r, const lit_subject *on, const photographs *p, int row)
{
    const int count = 1 << row;
    const several_options *o = r->options;
    network_estimation found = {0};
    float lights[MOST][MODEL_LIGHTS];
    const photo_group all = {p->photo, count, &p->mask, &p->how, o->views, o->stopped};
    status s = r->table->only_lights ? compare_photographs(r->network, &all, lights, NULL)
                                     : network_estimate_several(r->network, p->photo, count, &p->mask, &p->how,
                                                                o->views, o->stopped, lights, &found);
    if (s == OK && r->several && count > 1) s = compare_photographs(r->several, &all, lights, &found.maps);
    if (s == OK) {
        s = add_figures(&found.maps, on, r->table->mean[row]);
        for (int i = 0; i < count; i++)
            r->table->lamp[row] += lamp_error(&on->s->lamps[i], lights[i]) / count;
        r->table->count[row]++;
    }
    network_estimation_free(&found);
    return s;
}

static status measure_subject(void *context, const lit_subject *on)
{
    run *r = context;
    const sample *s = on->s;
    photographs all = {.how = {.lens = {s->fov, s->slant}}};
    status st = OK;
    if (s->mask.width != NETWORK_SIZE || s->mask.height != NETWORK_SIZE)
        st = fail(MERLIN_BAD_INPUT, "samples of %d×%d pixels: render them with --size %d", s->mask.width,
                  s->mask.height, NETWORK_SIZE);
    for (int i = 0; i < s->lamp_count && i < MOST && st == OK; i++)
        st = photograph(on, i, r->options->size, &all);
    for (int row = 0; row < SEVERAL_ROWS && 1 << row <= all.count && st == OK; row++)
        st = measure(r, on, &all, row);
    if (st == OK) r->table->samples++;
    photographs_free(&all);
    return st;
}

static status measure_file(void *context, const char *path)
{
    return lit_subject_measure(path, measure_subject, context);
}

static void finish(several_table *t)
{
    for (int row = 0; row < SEVERAL_ROWS; row++)
        t->lamp[row] = t->count[row] ? t->lamp[row] / (double)t->count[row] : (double)NAN;
    for (int row = 0; row < SEVERAL_ROWS; row++)
        for (int f = 0; f < LIT_FIGURES; f++)
            t->mean[row][f] = t->count[row] ? t->mean[row][f] / (double)t->count[row] : (double)NAN;
}

status several_table_run(const several_options *options, several_table *out)
{
    *out = (several_table){.samples = 0};
    const double began = clock_seconds();
    const eval_samples all = {options->data, "evaluating", options->count, options->quiet, options->stopped};
    run r = {.options = options, .table = out};
    model_config config;
    status s = model_load_config(options->weights, &config);
    if (s == OK) s = (config.only_lights ? network_open_several : network_open)(options->weights, &r.network);
    if (s != OK) return s;
    const model_config *c = network_config(r.network);
    snprintf(out->model, sizeof out->model, "%s", c->name);
    out->together = c->several;
    out->only_lights = c->only_lights;
    if (options->several) s = network_open_several(options->several, &r.several);
    if (s == OK && c->lighting == MODEL_LIGHT_ANY)
        s = eval_each_sample(&all, measure_file, &r);
    else if (s == OK)
        s = fail(MERLIN_BAD_INPUT, "%s: model \"%s\" is for flashes, not for lamps", options->weights, c->name);
    network_close(r.network);
    network_close(r.several);
    finish(out);
    out->seconds = clock_seconds() - began;
    return s;
}

/* ---- reports ---- */

enum { CELL = 16 };

void several_table_print(const several_table *t, FILE *stream)
{
    fprintf(stream, "%s%s on %zu samples; errors in 1e-2, relief in hundredths of the frame's width\n\n%-*s%*s",
            t->model, t->together ? "" : ", the mean of its estimates,", t->samples, CELL, "photographs", CELL,
            "samples");
    for (int f = 0; f < LIT_FIGURES && !t->only_lights; f++)
        fprintf(stream, "%*s", CELL, lit_figure_words[f].heading);
    fprintf(stream, "%*s", CELL, "lamps, degrees");
    for (int row = 0; row < SEVERAL_ROWS && t->count[row] > 0; row++) {
        fprintf(stream, "\n%-*d%*zu", CELL, 1 << row, CELL, t->count[row]);
        for (int f = 0; f < LIT_FIGURES && !t->only_lights; f++)
            fprintf(stream, "%*.2f", CELL, lit_figure_words[f].factor * t->mean[row][f]);
        fprintf(stream, "%*.1f", CELL, t->lamp[row]);
    }
    fprintf(stream, "\n\n%.1f s\n", t->seconds);
}

char *several_table_json(const several_table *t)
{
    cJSON *root = report_begin(&(warnings){0});
    json_put_text(root, "model", t->model);
    json_put_number(root, "samples", (double)t->samples);
    json_put_number(root, "seconds", t->seconds);
    cJSON *rows = json_put_object(root, "photographs");
    for (int row = 0; row < SEVERAL_ROWS && t->count[row] > 0; row++) {
        char name[16];
        snprintf(name, sizeof name, "%d", 1 << row);
        cJSON *o = json_put_object(rows, name);
        json_put_number(o, "samples", (double)t->count[row]);
        for (int f = 0; f < LIT_FIGURES && !t->only_lights; f++)
            json_put_number(o, lit_figure_words[f].key, t->mean[row][f]);
        json_put_number(o, "lamp_degrees", t->lamp[row]);
    }
    char *text = json_print_line(root);
    cJSON_Delete(root);
    return text;
}
