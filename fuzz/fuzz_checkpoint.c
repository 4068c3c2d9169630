/* SPDX-License-Identifier: MIT */
/* A checkpoint's words from arbitrary lines (counters, the open row of the curves, the best loss, the training's
 * configuration) around sound tensors: whatever is accepted must count no further than a run can. Files that are
 * damaged elsewhere are fuzz_safetensors' to find. */
#include <limits.h>
#include <math.h>
#include <string.h>

#include "fuzz_file.h"
#include "lab/train/checkpoint.h"
#include "nn/safetensors.h"

enum { WORDS = 4 };
static const char model[] = "{}", training[] = "{\"batch\":2,\"memory_gib\":1}";

typedef struct fixture {
    nn_graph *graph; /* NULL: not begun */
    char path[64];
    train_learner learner;
    safetensors_file *sound; /* a checkpoint as it is written */
    safetensors_tensor *tensors;
} fixture;

static void begin(fixture *f)
{
    nn_graph *g = f->graph = nn_graph_new();
    nn_node *image = nn_input(g, "image", 4, 1);
    nn_output(g, nn_conv2d(g, nn_compute(g, image), "conv", 8, 3, 1, NN_BIAS), "out");
    const nn_adam_options options = {.beta1 = 0.9f, .beta2 = 0.999f, .epsilon = 1e-8f};
    const train_identity identity = {.model = model, .training = training, .samples = 7};
    const train_state state = {0};
    if (nn_params_new(g, 1, &f->learner.params) != OK) abort();
    if (nn_adam_new(f->learner.params, &options, &f->learner.adam) != OK || !mkdtemp(fuzz_folder_path)) abort();
    atexit(fuzz_folder_remove);
    snprintf(fuzz_folder_link, sizeof fuzz_folder_link, "%s/a.safetensors", fuzz_folder_path);
    memcpy(f->path, fuzz_folder_link, sizeof f->path);
    if (train_checkpoint_write(f->path, &f->learner, &state, &identity) != OK) abort();
    if (safetensors_open(f->path, &f->sound) != OK) abort();
    f->tensors = calloc(safetensors_count(f->sound), sizeof *f->tensors);
    if (!f->tensors) abort();
    for (size_t i = 0; i < safetensors_count(f->sound); i++)
        f->tensors[i] = *safetensors_at(f->sound, i);
}

/* Cuts a text into its first lines. */
static void cut(char *text, const char *words[WORDS])
{
    for (int i = 0; i < WORDS; i++) {
        words[i] = text;
        text += strcspn(text, "\n");
        if (*text) *text++ = 0;
    }
}

static status write_checkpoint(const fixture *f, const char *const words[WORDS])
{
    const char *const metadata[][2] = {{"checkpoint", "1"},    {"config", model},         {"samples", "7"},
                                       {"counters", words[0]}, {"open_losses", words[1]}, {"best", words[2]},
                                       {"training", words[3]}};
    return safetensors_write(f->path, f->tensors, safetensors_count(f->sound), metadata,
                             sizeof metadata / sizeof *metadata);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static fixture f;
    if (!f.graph) begin(&f);
    const train_identity identity = {.model = model, .training = training, .samples = 7};
    const char *words[WORDS];
    train_state state = {0};
    char *text = malloc(size + 1);
    if (!text) abort();
    if (size > 0) memcpy(text, data, size);
    text[size] = 0;
    cut(text, words);
    if (write_checkpoint(&f, words) == OK && train_checkpoint_read(f.path, &f.learner, &state, &identity) == OK) {
        if (state.step < 0 || state.step > INT_MAX || state.open.count < 0 || state.open.count > INT_MAX) abort();
        if (isnan(state.best)) abort();
    }
    free(text);
    return 0;
}
