/* SPDX-License-Identifier: MIT */
#include "lab/train/checkpoint.h"

#include <cjson/cJSON.h>
#include <inttypes.h>
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "nn/safetensors.h"

enum { NAME = 128, PARTS = 4 };
static const char *const part_names[PARTS] = {"", "adam.moment1.", "adam.moment2.", "average."};

/* Returns a parameter's value (which 0), one of its moments or its mean; NULL if it has none. */
static float *part_of(const train_learner *l, size_t i, int which)
{
    nn_param *p = nn_params_at(l->params, i);
    if (which == 0) return p->value;
    if (which == 3) return l->average ? train_average_values(l->average, i) : NULL;
    return p->gradient ? nn_adam_moment(l->adam, i, which) : NULL;
}

static status collect(const train_learner *learner, safetensors_tensor *tensors, char (*names)[NAME], size_t *count)
{
    size_t n = 0;
    for (size_t i = 0; i < nn_params_count(learner->params); i++) {
        const nn_param *p = nn_params_at(learner->params, i);
        for (int which = 0; which < PARTS; which++) {
            const float *data = part_of(learner, i, which);
            if (!data) continue;
            if (snprintf(names[n], NAME, "%s%s", part_names[which], p->name) >= NAME)
                return fail(MERLIN_WRONG_USE, "parameter name %s is too long for a checkpoint", p->name);
            tensors[n] = (safetensors_tensor){
                .name = names[n], .type = SAFETENSORS_F32, .rank = p->rank, .count = p->count, .data = data};
            memcpy(tensors[n].shape, p->shape, sizeof p->shape);
            n++;
        }
    }
    *count = n;
    return OK;
}

/* Prints the losses as hexadecimal floats, which are exact. */
static void print_losses(const train_losses *l, char *out, size_t size)
{
    int n = snprintf(out, size, "%" PRId64 " %a", l->count, l->total);
    for (int i = 0; i < MODEL_LOSSES; i++)
        n += snprintf(out + n, size - (size_t)n, " %a", l->each[i]);
}

/* Tells whether n can be a number of steps: there are no more than presentations, which are an int. */
static bool is_count(int64_t n)
{
    return n >= 0 && n <= INT_MAX;
}

static bool scan_losses(const char *text, train_losses *l)
{
    char *end;
    l->count = strtoll(text, &end, 10);
    if (!is_count(l->count)) return false;
    l->total = strtod(end, &end);
    /* a checkpoint of an earlier version may lack the newest losses, which its model does not have */
    for (int i = 0; i < MODEL_LOSSES; i++)
        l->each[i] = *end ? strtod(end, &end) : (double)NAN;
    return *end == 0 && end != text;
}

static status write_tensors(const char *path, const safetensors_tensor *tensors, size_t count, const nn_adam *adam,
                            const train_state *state, const train_identity *identity)
{
    char counters[128], samples[32], processes[16], best[64], open[64 * (MODEL_LOSSES + 2)];
    snprintf(counters, sizeof counters, "%" PRId64 " %" PRId64 " %" PRId64, state->step, nn_adam_steps(adam),
             nn_adam_skipped(adam));
    snprintf(samples, sizeof samples, "%zu", identity->samples);
    snprintf(processes, sizeof processes, "%d", identity->ranks);
    snprintf(best, sizeof best, "%a", state->best);
    print_losses(&state->open, open, sizeof open);
    const char *const metadata[][2] = {
        {"checkpoint", "1"},  {"config", identity->model}, {"training", identity->training},
        {"samples", samples}, {"ranks", processes},        {"counters", counters},
        {"best", best},       {"open_losses", open}};
    return safetensors_write(path, tensors, count, metadata, sizeof metadata / sizeof *metadata);
}

status train_checkpoint_write(const char *path, const train_learner *learner, const train_state *state,
                              const train_identity *identity)
{
    size_t most = PARTS * nn_params_count(learner->params), count = 0;
    safetensors_tensor *tensors = calloc(most, sizeof *tensors);
    char(*names)[NAME] = calloc(most, sizeof *names);
    status s = tensors && names ? OK : fail(MERLIN_NO_MEMORY, "out of memory writing %s", path);
    if (s == OK) s = collect(learner, tensors, names, &count);
    if (s == OK) s = write_tensors(path, tensors, count, learner->adam, state, identity);
    free(names);
    free(tensors);
    return s;
}

static status must_equal(const char *path, const char *what, const char *found, const char *wanted)
{
    if (found && strcmp(found, wanted) == 0) return OK;
    return fail(MERLIN_BAD_INPUT, "%s was made with another %s; start afresh in another folder", path, what);
}

/* Tells whether a setting affects only how a run is executed, not its result. */
static bool is_of_no_matter(const char *key)
{
    return strcmp(key, "memory_gib") == 0 || strcmp(key, "checkpoint_minutes") == 0;
}

/* Returns the first key that b lacks or has another value for; NULL if there is none. */
static const char *first_difference(const cJSON *a, const cJSON *b)
{
    const cJSON *item;
    cJSON_ArrayForEach(item, a)
    {
        if (is_of_no_matter(item->string)) continue;
        if (!cJSON_Compare(item, cJSON_GetObjectItemCaseSensitive(b, item->string), true)) return item->string;
    }
    return NULL;
}

static status must_match(const char *path, const char *found, const char *wanted)
{
    cJSON *before = cJSON_Parse(found ? found : ""), *now = cJSON_Parse(wanted);
    const char *key = before && now ? first_difference(now, before) : "training";
    if (!key) key = first_difference(before, now);
    status s =
        key ? fail(MERLIN_BAD_INPUT, "%s was made with another \"%s\"; start afresh in another folder", path, key) : OK;
    cJSON_Delete(before);
    cJSON_Delete(now);
    return s;
}

/* Compares the numbers of ranks; checkpoints of a single process may not state theirs. */
static status must_have_ranks(const char *path, const char *found, int wanted)
{
    long before = found ? strtol(found, NULL, 10) : 1;
    if (before == wanted) return OK;
    return fail(MERLIN_BAD_INPUT,
                "%s was made by %ld %s, these are %d: go on with as many, or start afresh in another folder", path,
                before, before == 1 ? "process" : "ranks", wanted);
}

static status read_counters(const safetensors_file *f, const char *path, nn_adam *adam, train_state *state,
                            const train_identity *identity)
{
    char samples[32];
    snprintf(samples, sizeof samples, "%zu", identity->samples);
    status s = must_equal(path, "model configuration", safetensors_metadata(f, "config"), identity->model);
    if (s == OK) s = must_match(path, safetensors_metadata(f, "training"), identity->training);
    if (s == OK) s = must_equal(path, "number of samples", safetensors_metadata(f, "samples"), samples);
    if (s == OK) s = must_have_ranks(path, safetensors_metadata(f, "ranks"), identity->ranks);
    if (s != OK) return s;
    const char *counters = safetensors_metadata(f, "counters"), *open = safetensors_metadata(f, "open_losses");
    const char *best = safetensors_metadata(f, "best");
    int64_t steps = 0, skipped = 0;
    if (!counters || !open || !best || !scan_losses(open, &state->open) ||
        sscanf(counters, "%" SCNd64 " %" SCNd64 " %" SCNd64, &state->step, &steps, &skipped) != 3 ||
        !is_count(state->step) || !is_count(steps) || !is_count(skipped))
        return fail(MERLIN_BAD_INPUT, "%s is not a checkpoint of merlin-lab train", path);
    state->best = strtod(best, NULL);
    if (isnan(state->best)) return fail(MERLIN_BAD_INPUT, "%s is damaged: its best loss is no number", path);
    nn_adam_set_steps(adam, steps, skipped);
    return OK;
}

static status read_tensors(const safetensors_file *f, const char *path, const train_learner *learner)
{
    for (size_t i = 0; i < nn_params_count(learner->params); i++) {
        const nn_param *p = nn_params_at(learner->params, i);
        for (int which = 0; which < PARTS; which++) {
            float *to = part_of(learner, i, which);
            if (!to) continue;
            char name[NAME];
            snprintf(name, sizeof name, "%s%s", part_names[which], p->name);
            const safetensors_tensor *t = safetensors_find(f, name);
            if (!t || t->count != p->count || t->type != SAFETENSORS_F32)
                return fail(MERLIN_BAD_INPUT, "%s lacks the tensor %s", path, name);
            status s = safetensors_to_float(t, to);
            if (s != OK) return s;
        }
    }
    nn_params_touch(learner->params);
    return OK;
}

status train_checkpoint_read(const char *path, const train_learner *learner, train_state *state,
                             const train_identity *identity)
{
    safetensors_file *f;
    status s = safetensors_open(path, &f);
    if (s != OK) return s;
    s = read_counters(f, path, learner->adam, state, identity);
    if (s == OK) s = read_tensors(f, path, learner);
    safetensors_close(f);
    return s;
}

void train_checkpoint_share(const ranks *together, const train_learner *l, train_state *state)
{
    int64_t steps[] = {nn_adam_steps(l->adam), nn_adam_skipped(l->adam)};
    for (size_t i = 0; i < nn_params_count(l->params); i++)
        for (int which = 0; which < PARTS; which++) {
            float *values = part_of(l, i, which);
            if (values) ranks_broadcast(together, values, nn_params_at(l->params, i)->count * sizeof *values);
        }
    ranks_broadcast(together, steps, sizeof steps);
    ranks_broadcast(together, state, sizeof *state);
    nn_adam_set_steps(l->adam, steps[0], steps[1]);
    nn_params_touch(l->params);
}
