/* SPDX-License-Identifier: MIT */
#include "lab/bench/bench_stereo.h"

#include <cjson/cJSON.h>
#include <stdlib.h>

#include "base/json/json_put.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "base/progress.h"
#include "base/text/report.h"
#include "lab/bench/bench_estimate.h"
#include "lab/bench/bench_time.h"
#include "stereo/methods/solve.h"

static const bench_stereo_run cases[BENCH_STEREO_RUNS] = {
    {.pictures = 8}, {.pictures = 32}, {.pictures = 32, .shadows = true}};

typedef struct fill_work {
    uint16_t *codes;
    uint32_t seed;
    size_t row, shadow; /* row: values a row; shadow: where a shadow of a sixth of a row begins in the first one */
    bool shadows;
} fill_work;

/* Fills in values between 6000 and 60000, neither dark nor saturated, with slanted shadows. */
static void fill_block(void *context, size_t begin, size_t end)
{
    const fill_work *w = context;
    for (size_t i = begin; i < end; i++) {
        bool dark = w->shadows && (i + i / w->row * 3 + w->shadow) % w->row < w->row / 6;
        w->codes[i] = dark ? 0 : (uint16_t)(6000 + ((uint32_t)i * 2654435761u + w->seed) % 54000);
    }
}

static status add_picture(merlin_capture *c, bool shadows)
{
    size_t row = (size_t)c->width * (size_t)c->channels, values = row * (size_t)c->height, k = (size_t)c->count;
    fill_work w = {.codes = malloc(values * sizeof *w.codes),
                   .seed = (uint32_t)k * 40503u,
                   .row = row,
                   .shadow = k * row / 7,
                   .shadows = shadows};
    if (!w.codes) return fail(MERLIN_NO_MEMORY, "no memory for %zu pictures of %dx%d", k + 1, c->width, c->height);
    memory_prefer_large_pages(w.codes, values * sizeof *w.codes);
    parallel_blocks(values, fill_block, &w);
    float turn = 2.4f * (float)k;
    vec3 to_light = vec3_normalize(vec3_make(cosf(turn), sinf(turn), 1.5f));
    c->light[k] = (merlin_light){.direction = {to_light.x, to_light.y, to_light.z}, .intensity = {1, 1, 1}};
    c->picture[c->count++] = (pst_plane){.wide = w.codes};
    return OK;
}

static status make_capture(const bench_stereo_report *report, const bench_stereo_run *run, merlin_capture *c)
{
    *c = (merlin_capture){.width = report->width,
                          .height = report->height,
                          .channels = report->channels,
                          .lighting = MERLIN_DISTANT_LIGHTS,
                          .intensities_known = true};
    status s = pst_capture_reserve(c, (size_t)run->pictures);
    c->count = 0; /* until the pictures are added */
    if (s == OK) s = img_new(&c->mask, c->width, c->height, 1);
    for (size_t i = 0, n = (size_t)c->width * (size_t)c->height; s == OK && i < n; i++)
        c->mask.data[i] = 1;
    for (int k = 0; k < run->pictures && s == OK; k++)
        s = add_picture(c, run->shadows);
    return s;
}

static status solve(void *context)
{
    merlin_surface found;
    status s = pst_solve(context, &(merlin_stereo_params){.method = MERLIN_STEREO_LS}, &found);
    if (s == OK) merlin_surface_free(&found);
    return s;
}

static status measure(const bench_stereo_options *o, const bench_stereo_report *report, bench_stereo_run *out)
{
    merlin_capture c;
    status s = make_capture(report, out, &c);
    out->input_bytes = (size_t)c.count * (size_t)c.width * (size_t)c.height * (size_t)c.channels * sizeof(uint16_t);
    bench_reset_resident();
    size_t before = bench_peak_resident();
    if (s == OK) s = bench_time(solve, &c, bench_budget_of(o->quick), &out->seconds);
    size_t most = bench_peak_resident();
    out->working_bytes = before && most > before ? most - before : 0;
    pst_capture_free(&c);
    return s;
}

status bench_stereo(const bench_stereo_options *options, bench_stereo_report *out)
{
    *out = (bench_stereo_report){.threads = parallel_threads(), .channels = 3};
    out->width = options->quick ? 1152 : 4000;
    out->height = options->quick ? 864 : 3000;
    progress p;
    progress_begin(&p, "measuring", "stages", 0, 1 + BENCH_STEREO_RUNS, options->quiet);
    status s = bench_copy_rate(bench_budget_of(options->quick), &out->copy_rate);
    for (int i = 0; i < BENCH_STEREO_RUNS && s == OK; i++) {
        progress_update(&p, (size_t)i + 1, "least squares");
        out->run[i] = cases[i];
        s = options->stopped && options->stopped() ? fail(MERLIN_STOPPED, "stopped")
                                                   : measure(options, out, &out->run[i]);
    }
    progress_end(&p);
    return s;
}

/* Returns bytes of pictures a second. */
static double rate(const bench_stereo_run *run)
{
    return (double)run->input_bytes / run->seconds;
}

void bench_stereo_print(const bench_stereo_report *r, FILE *stream)
{
    fprintf(stream, "this machine, %d threads: memory copied at %.1f GB/s (read and written)\n\n", r->threads,
            r->copy_rate * 1e-9);
    fprintf(stream, "%-44s%9s%9s%9s%9s%20s\n", "photometric stereo by least squares", "pictures", "ms", "GB/s",
            "of copy", "memory beyond them");
    for (int i = 0; i < BENCH_STEREO_RUNS; i++) {
        const bench_stereo_run *run = &r->run[i];
        char what[64];
        snprintf(what, sizeof what, "%dx%d, %d channels of 16 bits%s", r->width, r->height, r->channels,
                 run->shadows ? ", shadows" : "");
        fprintf(stream, "%-44s%9d%9.1f%9.2f%8.0f %%%15.0f MB\n", what, run->pictures, run->seconds * 1e3,
                rate(run) * 1e-9, 100 * rate(run) / r->copy_rate, (double)run->working_bytes * 1e-6);
    }
}

char *bench_stereo_json(const bench_stereo_report *r)
{
    cJSON *o = report_begin(&(warnings){0});
    json_put_number(o, "threads", r->threads);
    json_put_number(o, "copy_bytes_per_second", r->copy_rate);
    json_put_number(o, "width", r->width);
    json_put_number(o, "height", r->height);
    json_put_number(o, "channels", r->channels);
    cJSON *runs = json_put_array(o, "least_squares");
    for (int i = 0; i < BENCH_STEREO_RUNS; i++) {
        const bench_stereo_run *run = &r->run[i];
        cJSON *one = json_append_object(runs);
        json_put_number(one, "pictures", run->pictures);
        json_put_bool(one, "shadows", run->shadows);
        json_put_number(one, "seconds", run->seconds);
        json_put_number(one, "input_bytes", (double)run->input_bytes);
        json_put_number(one, "bytes_per_second", rate(run));
        json_put_number(one, "share_of_copy_rate", rate(run) / r->copy_rate);
        json_put_number(one, "working_bytes", (double)run->working_bytes);
    }
    char *text = json_print(o);
    cJSON_Delete(o);
    return text;
}
