/* SPDX-License-Identifier: MIT */
#include <cjson/cJSON.h>

#include "base/json/json_put.h"
#include "base/text/report.h"
#include "lab/bench/bench.h"
#include "lab/bench/bench_network.h"

/* Goals of docs/performance.md: shares of the peak, seconds and megabytes. */
static const double least_inference_share = 0.55, least_training_share = 0.55, most_estimate_seconds = 0.25;
static const double most_estimate_megabytes = 150;

/* Names, by merlin_relighting. */
static const char *const way_names[BENCH_WAYS] = {"brdf", "network", "brdf without shadows"};
static const char *const way_keys[BENCH_WAYS] = {"brdf", "network", "brdf_unshadowed"};

static double megabytes(size_t bytes)
{
    return (double)bytes / 1e6;
}

static const char *holds(bool yes)
{
    return yes ? "yes" : "no";
}

static void print_network(FILE *stream, const char *what, const char *type, const bench_network *n, double least)
{
    fprintf(stream, "%-34s%-10s%9.1f%9.1f%10.0f%8.0f %%%8.0f MB%8.0f MB   >= %.0f %%    %s\n", what, type,
            n->seconds * 1e3, n->flops * 1e-9, n->flops / n->seconds * 1e-9, n->share * 100, megabytes(n->bytes),
            megabytes(n->resident_bytes), least * 100, holds(n->share >= least));
}

static void print_networks(const bench_report *r, FILE *stream)
{
    char training[64];
    snprintf(training, sizeof training, "training step, %d of 128x128", r->batch);
    fprintf(stream, "\n%-34s%-10s%9s%9s%10s%10s%11s%11s   %-10s %s\n", r->model, "", "ms", "GFLOP", "GFLOP/s",
            "of peak", "planned", "resident", "goal", "holds");
    for (int t = 0; t < BENCH_TYPES; t++)
        if (r->measured[t])
            print_network(stream, "inference, one of 256x256", bench_type_name((nn_type)t), &r->inference[t],
                          least_inference_share);
    for (int t = 0; t < BENCH_TYPES; t++)
        if (r->measured[t])
            print_network(stream, training, bench_type_name((nn_type)t), &r->training[t], least_training_share);
}

static void print_estimate(const bench_estimation *e, FILE *stream)
{
    fprintf(stream, "\nmerlin estimate, picture of 256x256: %.3f s (at most %.2f: %s), %.0f MB (at most %.0f: %s)\n",
            e->seconds, most_estimate_seconds, holds(e->seconds <= most_estimate_seconds), megabytes(e->bytes),
            most_estimate_megabytes, holds(megabytes(e->bytes) <= most_estimate_megabytes));
    fprintf(stream, "  of these, milliseconds:");
    for (int i = 0; i < BENCH_PARTS; i++)
        fprintf(stream, "%s %s %.0f", i ? "," : "", e->part[i].name, e->part[i].seconds * 1e3);
    fputc('\n', stream);
}

static void print_relight(const bench_relighting *b, FILE *stream)
{
    fprintf(stream, "each light by a relighter of 256x256, milliseconds (to make it):");
    for (int i = 0; i < BENCH_WAYS; i++)
        fprintf(stream, "%s %s %.1f (%.0f)", i ? "," : "", way_names[i], b->light_seconds[i] * 1e3,
                b->ready_seconds[i] * 1e3);
    fputc('\n', stream);
}

void bench_print_table(const bench_report *r, FILE *stream)
{
    fprintf(stream, "this machine, %d threads: memory copied at %.1f GB/s\n\n", r->threads, r->copy_rate * 1e-9);
    fprintf(stream, "%-34s%12s%15s%18s%15s\n", "peak of convolutions, GFLOP/s", "forward", "backward data",
            "backward weights", "training peak");
    for (int t = 0; t < BENCH_TYPES; t++) {
        const nn_peak *p = &r->peak[t];
        if (r->measured[t])
            fprintf(stream, "%-34s%12.0f%15.0f%18.0f%15.0f\n", bench_type_name((nn_type)t), p->forward * 1e-9,
                    p->backward_data * 1e-9, p->backward_weights * 1e-9, bench_peak_for(p, NN_TRAIN) * 1e-9);
        else
            fprintf(stream, "%-34s%12s\n", bench_type_name((nn_type)t), "-");
    }
    print_networks(r, stream);
    print_estimate(&r->estimate, stream);
    print_relight(&r->relight, stream);
    fprintf(stream, "rendering at 128x128: %.2f samples/s, %.2f million rays/s (%zu samples)\n",
            (double)r->samples / r->render_seconds, (double)r->rays / r->render_seconds * 1e-6, r->samples);
}

static void add_network(cJSON *parent, const char *key, const bench_network *n, double least)
{
    cJSON *o = json_put_object(parent, key);
    json_put_number(o, "seconds", n->seconds);
    json_put_number(o, "gflop", n->flops * 1e-9);
    json_put_number(o, "gflop_per_second", n->flops / n->seconds * 1e-9);
    json_put_number(o, "share_of_peak", n->share);
    json_put_number(o, "planned_bytes", (double)n->bytes);
    json_put_number(o, "resident_bytes", (double)n->resident_bytes);
    json_put_number(o, "goal", least);
    json_put_bool(o, "holds", n->share >= least);
}

static void add_type(cJSON *parent, const bench_report *r, int t)
{
    cJSON *o = json_put_object(parent, bench_type_name((nn_type)t));
    json_put_number(o, "peak_forward", r->peak[t].forward * 1e-9);
    json_put_number(o, "peak_backward_data", r->peak[t].backward_data * 1e-9);
    json_put_number(o, "peak_backward_weights", r->peak[t].backward_weights * 1e-9);
    json_put_number(o, "peak_training", bench_peak_for(&r->peak[t], NN_TRAIN) * 1e-9);
    add_network(o, "inference_256", &r->inference[t], least_inference_share);
    add_network(o, "training_128", &r->training[t], least_training_share);
}

static void add_relight(cJSON *parent, const bench_relighting *b)
{
    cJSON *relight = json_put_object(parent, "relight_256");
    for (int i = 0; i < BENCH_WAYS; i++) {
        cJSON *way = json_put_object(relight, way_keys[i]);
        json_put_number(way, "stage_seconds", b->ready_seconds[i]);
        json_put_number(way, "light_seconds", b->light_seconds[i]);
    }
}

char *bench_report_json(const bench_report *r)
{
    cJSON *o = report_begin(&(warnings){0});
    json_put_text(o, "model", r->model);
    json_put_number(o, "threads", r->threads);
    json_put_number(o, "training_batch", r->batch);
    json_put_number(o, "copy_bytes_per_second", r->copy_rate);
    for (int t = 0; t < BENCH_TYPES; t++)
        if (r->measured[t]) add_type(o, r, t);
    cJSON *estimate = json_put_object(o, "estimate_256");
    const bench_estimation *e = &r->estimate;
    json_put_number(estimate, "seconds", e->seconds);
    cJSON *parts = json_put_object(estimate, "parts");
    for (int i = 0; i < BENCH_PARTS; i++)
        json_put_number(parts, e->part[i].name, e->part[i].seconds);
    json_put_number(estimate, "resident_bytes", (double)e->bytes);
    json_put_bool(estimate, "holds",
                  e->seconds <= most_estimate_seconds && megabytes(e->bytes) <= most_estimate_megabytes);
    add_relight(o, &r->relight);
    cJSON *rendering = json_put_object(o, "rendering_128");
    json_put_number(rendering, "samples_per_second", (double)r->samples / r->render_seconds);
    json_put_number(rendering, "rays_per_second", (double)r->rays / r->render_seconds);
    char *text = json_print(o);
    cJSON_Delete(o);
    return text;
}
