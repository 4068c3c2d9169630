/* SPDX-License-Identifier: MIT */
#include "lab/train/train.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/messages.h"
#include "base/progress.h"
#include "lab/train/checkpoint.h"
#include "lab/train/train_paths.h"
#include "lab/train/train_programs.h"
#include "lab/train/train_rates.h"

typedef struct run {
    const train_options *options;
    model_config model;
    train_config training;
    char *model_json, *training_json;
    train_paths paths;
    train_dataset *data;
    size_t training_count;
    int batch; /* of this rank: its share of the configuration's */
    nn_graph *graph;
    nn_params *params;
    nn_adam *adam;
    train_average *average; /* NULL: the last weights are the run's result */
    train_programs programs;
    nn_program *last;          /* the program of the last step */
    train_programs validation; /* the same losses by running statistics; empty: none */
    train_order order;
    train_state state;
    double resumed_at, saved_at, seconds_before; /* seconds: of the machine's clock, spent training */
    bool chart_missed;                           /* a chart could not be drawn, which has been reported */
} run;

static void close_run(run *r)
{
    train_order_free(&r->order);
    train_programs_free(&r->programs);
    train_programs_free(&r->validation);
    train_average_free(r->average);
    nn_adam_free(r->adam);
    nn_params_free(r->params);
    nn_graph_free(r->graph);
    train_dataset_close(r->data);
    train_paths_free(&r->paths);
    free(r->model_json);
    free(r->training_json);
}

static bool is_first(const run *r)
{
    return ranks_index(r->options->together) == 0;
}

/* The network of near lights. */
static bool is_nfps(const run *r)
{
    return r->model.nfps_width > 0;
}

static status read_configuration(run *r)
{
    const int sharing = ranks_count(r->options->together);
    status s = train_config_read(r->options->config, &r->model, &r->training);
    if (s != OK) return s;
    r->batch = r->training.batch / sharing;
    if (r->training.batch % sharing)
        return fail(MERLIN_WRONG_USE, "a batch of %d is not to be shared by %d ranks", r->training.batch, sharing);
    if (r->training.most_pictures != 1 && !r->model.several && !is_nfps(r))
        return fail(MERLIN_BAD_INPUT, "%s: \"most_pictures\" needs a model with \"several\"", r->options->config);
    r->model_json = model_config_write(&r->model);
    return r->model_json ? OK : fail(MERLIN_NO_MEMORY, "out of memory");
}

/* Copies rank 0's number type to all ranks, as each would choose the faster one of its machine. */
static void share_type(run *r)
{
    int type = (int)r->training.type;
    ranks_broadcast(r->options->together, &type, sizeof type);
    r->training.type = (nn_type)type;
}

/* Records the number type that is used instead of "auto": another type would give other sums. */
static status record_training(run *r)
{
    r->training.type = nn_program_type(r->programs.at[0].program);
    r->training_json = train_config_write(&r->training);
    return r->training_json ? OK : fail(MERLIN_NO_MEMORY, "out of memory");
}

static bool is_lit_by_both(const run *r)
{
    return r->model.lighting == MODEL_LIGHT_BOTH;
}

static bool is_lit_by_any(const run *r)
{
    return r->model.lighting == MODEL_LIGHT_ANY;
}

static status open_data(run *r)
{
    train_dataset_options options = {.size = r->training.size * (is_nfps(r) ? 2 : 1),
                                     .memory_gib = r->training.memory_gib,
                                     .environment = is_lit_by_both(r),
                                     .lamps = is_lit_by_any(r),
                                     .targets = is_nfps(r)};
    status s = train_dataset_open(r->options->data, &options, &r->data);
    if (s != OK) return s;
    size_t count = train_dataset_count(r->data), held_back = (size_t)r->training.validation_count;
    if (count <= held_back)
        return fail(MERLIN_BAD_INPUT, "%s holds %zu samples and \"validation_count\" %zu leaves none to train on",
                    r->options->data, count, held_back);
    r->training_count = count - held_back;
    return train_order_new(&r->order, (uint64_t)r->training.seed, r->training_count);
}

static void weigh_losses_of(nn_program *p, const train_config *c)
{
    nn_set_loss_weight(p, "albedo", (float)c->albedo_weight);
    nn_set_loss_weight(p, "depth", (float)c->depth_weight);
    nn_set_loss_weight(p, "lamp", (float)c->lamp_weight);
    nn_set_loss_weight(p, "relight_brdf", (float)c->relight_brdf_weight);
    nn_set_loss_weight(p, "relight_ssim", (float)c->ssim_weight);
    nn_set_loss_weight(p, "relight_brdf_ssim", (float)c->ssim_weight);
}

static void weigh_losses(const train_programs *programs, const train_config *c)
{
    for (int i = 0; i < programs->count; i++)
        weigh_losses_of(programs->at[i].program, c);
}

/* Returns the part of the graph with the losses that are configured. */
static model_part part_of(const train_config *c)
{
    if (c->ssim_weight > 0) return MODEL_TRAINING_SSIM;
    return c->relight_brdf_weight > 0 ? MODEL_TRAINING_BRDF : MODEL_TRAINING;
}

static status load_weights(nn_params *params, const train_options *o)
{
    status s = o->init ? nn_params_load(params, o->init) : OK;
    for (const char *const *w = o->init_shared; s == OK && w && *w; w++)
        s = nn_params_load_shared(params, *w);
    return s;
}

static status build(run *r)
{
    const train_config *c = &r->training;
    nn_options options = {.batch = r->batch,
                          .height = c->size,
                          .width = c->size,
                          .type = c->type,
                          .purpose = NN_TRAIN,
                          .together = r->options->together};
    nn_adam_options adam = {(float)c->beta1, (float)c->beta2, 1e-8f, (float)c->clip_norm, (float)c->weight_decay};
    train_source source = {.data = r->data,
                           .config = c,
                           .input_global = r->model.input_global,
                           .environment = is_lit_by_both(r),
                           .any = is_lit_by_any(r),
                           .nfps = is_nfps(r),
                           .training_count = r->training_count,
                           .batch = r->batch,
                           .pictures = 1};
    status s = model_build(&r->model, part_of(c), &r->graph);
    if (s == OK) s = nn_params_new(r->graph, (uint64_t)c->seed, &r->params);
    if (s == OK) s = load_weights(r->params, r->options);
    if (s == OK) s = train_rates_set(&r->model, c, r->params);
    if (s == OK) s = nn_adam_new(r->params, &adam, &r->adam);
    if (s == OK && c->average_decay > 0) s = train_average_new(r->params, c->average_decay, &r->average);
    if (s == OK) s = train_programs_new(r->graph, r->params, &options, &source, (int)c->most_pictures, &r->programs);
    if (s == OK) s = record_training(r);
    if (s != OK) return s;
    weigh_losses(&r->programs, c);
    if (c->validation_count == 0) return OK;
    options.purpose = NN_INFER;
    s = train_programs_new(r->graph, r->params, &options, &source, (int)c->most_pictures, &r->validation);
    weigh_losses(&r->validation, c);
    return s;
}

static train_learner learner_of(const run *r)
{
    return (train_learner){r->params, r->adam, r->average};
}

static train_identity identity_of(const run *r)
{
    return (train_identity){r->model_json, r->training_json, train_dataset_count(r->data),
                            ranks_count(r->options->together)};
}

/* Writes the time spent beside the checkpoint, not into it: a resumed run's files equal those of an uninterrupted one.
 */
static status write_seconds(const run *r)
{
    char text[32];
    int n = snprintf(text, sizeof text, "%.0f\n", r->seconds_before + r->saved_at - r->resumed_at);
    return file_write(r->paths.seconds, text, (size_t)n);
}

static status read_seconds(run *r)
{
    char *text;
    size_t size;
    if (!file_exists(r->paths.seconds)) return OK;
    status s = file_read(r->paths.seconds, 1 << 10, &text, &size);
    if (s != OK) return s;
    r->seconds_before = strtod(text, NULL);
    free(text);
    return OK;
}

static status resume(run *r)
{
    train_identity identity = identity_of(r);
    train_learner learner = learner_of(r);
    status s = train_checkpoint_read(r->paths.checkpoint, &learner, &r->state, &identity);
    if (s == OK) s = train_curve_truncate(r->paths.curves, r->state.step);
    if (s == OK) s = train_curve_truncate(r->paths.validation, r->state.step);
    return s == OK ? read_seconds(r) : s;
}

/* Opens the files that only rank 0 reads and writes. */
static status begin_files(run *r)
{
    status s = file_make_folder(r->options->output);
    if (s != OK) return s;
    if (r->options->resume) return resume(r);
    /* removes curves left by a run that never wrote a checkpoint */
    s = train_curve_truncate(r->paths.curves, 0);
    return s == OK ? train_curve_truncate(r->paths.validation, 0) : s;
}

static status begin(run *r)
{
    ranks *together = r->options->together;
    r->state.best = INFINITY;
    status s = ranks_agree(together, read_configuration(r));
    if (s != OK) return s;
    share_type(r);
    if (is_first(r)) s = train_paths_new(r->options, &r->paths);
    if (s == OK) s = open_data(r);
    if (s == OK) s = build(r);
    r->resumed_at = r->saved_at = clock_seconds();
    if (s == OK && is_first(r)) s = begin_files(r);
    s = ranks_agree(together, s);
    if (s != OK || ranks_count(together) == 1) return s;
    train_learner learner = learner_of(r);
    train_checkpoint_share(together, &learner, &r->state);
    return OK;
}

static int64_t presented(const run *r)
{
    return r->state.step * r->training.batch;
}

/* Returns where this rank's share of the next batch begins. */
static uint64_t own_presentations(const run *r)
{
    return (uint64_t)(presented(r) + (int64_t)ranks_index(r->options->together) * r->batch);
}

static status export_weights(run *r)
{
    if (!is_first(r)) return OK;
    train_provenance from = {.config = r->model_json,
                             .training = r->training_json,
                             .note = r->options->note,
                             .presentations = presented(r),
                             .samples = (int64_t)r->training_count,
                             .size = r->training.size,
                             .generator_version = train_dataset_generator_version(r->data),
                             .validation_loss = r->state.best};
    return train_export(r->paths.weights, r->params, &from);
}

/* Runs a function with the weights' mean in place of the weights, if the run has one. */
static status with_average(run *r, status (*act)(run *))
{
    if (!r->average) return act(r);
    train_average_swap(r->average);
    status s = act(r);
    train_average_swap(r->average);
    return s;
}

/* Draws the chart. It shows only what the tables contain, so that training goes on if it, or libvips, which draws it,
 * fails. */
static void draw_chart(run *r)
{
    status s = train_curve_chart(r->paths.curves, r->paths.validation, r->paths.chart);
    if (s != OK && !r->chart_missed && !r->options->quiet)
        fprintf(messages(), "\nmerlin-lab train: no chart is drawn, training goes on: %s\n", status_message());
    if (s != OK) r->chart_missed = true;
}

static status save(run *r)
{
    r->saved_at = clock_seconds();
    if (!is_first(r)) return OK;
    train_identity identity = identity_of(r);
    train_learner learner = learner_of(r);
    /* before the checkpoint: after the last one nothing is repeated */
    status s = r->validation.count ? OK : with_average(r, export_weights);
    if (s == OK) s = train_curve_keep(r->paths.curves);
    if (s == OK) s = train_curve_keep(r->paths.validation);
    if (s == OK) s = train_checkpoint_write(r->paths.checkpoint, &learner, &r->state, &identity);
    if (s == OK) s = write_seconds(r);
    if (s == OK) draw_chart(r);
    return s;
}

static int64_t last_step(const run *r)
{
    return ((int64_t)r->training.presentations + r->training.batch - 1) / r->training.batch;
}

static train_curve_row row_of(const run *r)
{
    return (train_curve_row){.step = r->state.step,
                             .presentations = presented(r),
                             .skipped = nn_adam_skipped(r->adam),
                             .learning_rate =
                                 train_learning_rate(&r->training, r->training_count,
                                                     (uint64_t)(r->state.step - 1) * (uint64_t)r->training.batch)};
}

static const train_program *program_at(const run *r, int64_t step)
{
    return train_programs_at(&r->programs, (uint64_t)r->training.seed, (uint64_t)step);
}

/* Recomputes batch norm's running statistics as the mean over many batches with fixed weights ("precise BN", Wu and
 * Johnson 2021). The moving averages cover ten batches, too few for the coarsest level, where a handful of pixels
 * decides about the depth of the whole object. The batches are those that come next. */
static status settle_statistics(run *r)
{
    enum { SETTLING_BATCHES = 64 };
    uint64_t first = own_presentations(r);
    status s = OK;
    for (int i = 0; s == OK && i < SETTLING_BATCHES; i++) {
        const train_program *p = program_at(r, r->state.step + i);
        nn_set_norm_momentum(p->program, 1.0f / (float)(i + 1));
        s = train_loader_training(p->loader, &r->order, first + (uint64_t)i * (uint64_t)r->training.batch);
        if (s == OK) s = nn_forward(p->program);
        nn_set_norm_momentum(p->program, NN_NORM_MOMENTUM);
    }
    nn_params_touch(r->params);
    return s;
}

static status validate(run *r)
{
    train_losses losses = {0};
    status settled = settle_statistics(r);
    if (settled != OK) return settled;
    for (int first = 0; first < r->training.validation_count; first += r->training.batch) {
        const int own = first + ranks_index(r->options->together) * r->batch;
        const train_program *p = &r->validation.at[first / r->training.batch % r->validation.count];
        status s = train_loader_validation(p->loader, (size_t)own);
        if (s == OK) s = nn_forward(p->program);
        if (s != OK) return s;
        train_losses_add(&losses, p->program);
    }
    train_curve_row row = row_of(r);
    status s = is_first(r) ? train_curve_append(r->paths.validation, &row, &losses) : OK;
    double mean = losses.total / (double)losses.count;
    if (s != OK || !(mean < r->state.best)) return s;
    r->state.best = mean;
    return export_weights(r);
}

static status end_row(run *r)
{
    train_curve_row row = row_of(r);
    status s = is_first(r) ? train_curve_append(r->paths.curves, &row, &r->state.open) : OK;
    if (s == OK && !isfinite(r->state.open.total))
        s = fail(MERLIN_BAD_INPUT, "training diverged before step %lld: lower \"learning_rate\" or \"clip_norm\"",
                 (long long)r->state.step);
    r->state.open = (train_losses){0};
    return s;
}

static status one_step(run *r)
{
    uint64_t first = (uint64_t)presented(r);
    const train_program *p = program_at(r, r->state.step);
    status s = train_loader_training(p->loader, &r->order, own_presentations(r));
    if (s == OK) s = nn_forward(p->program);
    if (s == OK) s = nn_backward(p->program);
    if (s == OK) s = nn_adam_step(r->adam, (float)train_learning_rate(&r->training, r->training_count, first));
    if (s != OK) return s;
    train_losses_add(&r->state.open, p->program);
    r->last = p->program;
    r->state.step++;
    if (r->average) train_average_add(r->average, r->state.step, r->state.step == last_step(r));
    if (r->state.step % r->training.curve_steps == 0) s = end_row(r);
    if (s == OK && r->validation.count && r->training.validation_steps &&
        r->state.step % r->training.validation_steps == 0)
        s = with_average(r, validate);
    return s;
}

/* Tells whether to write a checkpoint. Not after the last step: that checkpoint states that the run is complete, and
 * the last validation is still to come. */
static bool is_time_to_save(const run *r, int64_t last)
{
    return r->state.step < last && clock_seconds() - r->saved_at > 60 * r->training.checkpoint_minutes;
}

/* Finds out whether any rank was asked to stop. */
static status ask_to_stop(const run *r, bool *stop)
{
    double asked = r->options->interrupted && r->options->interrupted();
    status s = ranks_sum(r->options->together, &asked, 1);
    *stop = asked > 0;
    return s;
}

static status steps(run *r, int64_t last, progress *bar)
{
    while (r->state.step < last) {
        bool stop = false;
        status s = one_step(r);
        if (s == OK && is_time_to_save(r, last)) s = save(r);
        if (s != OK) return s;
        char note[64];
        snprintf(note, sizeof note, "loss %.4f", (double)nn_total_loss(r->last));
        progress_update(bar, (size_t)presented(r), note);
        if (r->state.step < last) s = ask_to_stop(r, &stop);
        if (s != OK) return s;
        if (stop) {
            s = save(r);
            return s != OK ? s
                           : fail(MERLIN_STOPPED, "stopped after %lld presentations; --resume goes on from there",
                                  (long long)presented(r));
        }
    }
    return OK;
}

static status go(run *r)
{
    int64_t last = last_step(r), validation_steps = r->training.validation_steps;
    bool finished_before = r->state.step >= last;
    progress bar;
    progress_begin(&bar, "train", "presentations", (size_t)presented(r), (size_t)(last * r->training.batch),
                   r->options->quiet || !is_first(r));
    status s = steps(r, last, &bar);
    progress_end(&bar);
    if (s != OK || finished_before) return s;
    if (!r->validation.count) s = with_average(r, settle_statistics);
    if (r->validation.count && (validation_steps == 0 || last % validation_steps != 0)) s = with_average(r, validate);
    return s == OK ? save(r) : s;
}

status train_run(const train_options *o)
{
    run r = {.options = o};
    status s = begin(&r);
    if (s == OK) s = go(&r);
    close_run(&r);
    return s;
}
