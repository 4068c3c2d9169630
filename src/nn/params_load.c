/* SPDX-License-Identifier: MIT */
/* Loads parameters from a safetensors file. */
#include <string.h>

#include "base/parallel.h"
#include "nn/params.h"
#include "nn/safetensors.h"

static bool is_of_shape(const safetensors_tensor *t, const nn_param *p)
{
    bool same = t->rank == p->rank;
    for (int i = 0; same && i < p->rank; i++)
        same = t->shape[i] == p->shape[i];
    return same;
}

static status check_tensor(const nn_param *p, const safetensors_tensor *t, const char *path)
{
    if (!t) return fail(MERLIN_BAD_INPUT, "%s: tensor %s is missing", path, p->name);
    if (!is_of_shape(t, p))
        return fail(MERLIN_BAD_INPUT, "%s: tensor %s has another shape than the model's", path, p->name);
    if (t->type == SAFETENSORS_I64)
        return fail(MERLIN_BAD_INPUT, "%s: tensor %s is not of a float type", path, p->name);
    return OK;
}

/* Copies a tensor's values; a parameter kept as half floats has a tensor of half floats. */
static status take_values(const nn_param *p, const safetensors_tensor *t)
{
    if (!p->half) return safetensors_to_float(t, p->value);
    memcpy(p->half, t->data, t->count * sizeof *p->half);
    return OK;
}

typedef struct taking {
    nn_params *params;
    const safetensors_file *file;
    const char *path;
} taking;

static status take_one(void *context, size_t i)
{
    const taking *t = context;
    const nn_param *p = &t->params->items[i];
    status s = take_values(p, safetensors_find(t->file, p->name));
    return s == OK ? OK : fail_in(s, "%s: tensor %s", t->path, p->name);
}

status params_take(nn_params *params, const safetensors_file *f, const char *path)
{
    for (size_t i = 0; i < params->count; i++) {
        status s = check_tensor(&params->items[i], safetensors_find(f, params->items[i].name), path);
        if (s != OK) return s;
    }
    for (size_t i = 0; i < safetensors_count(f); i++) {
        const char *name = safetensors_at(f, i)->name;
        if (!nn_params_find(params, name))
            return fail(MERLIN_BAD_INPUT, "%s: the model has no parameter for tensor %s", path, name);
    }
    status s = parallel_try(params->count, take_one, &(taking){params, f, path});
    if (s == OK) nn_params_touch(params);
    return s;
}

status nn_params_open(const nn_graph *g, const safetensors_file *f, const char *path, nn_params **out)
{
    nn_params *params;
    status s = params_like(g, f, &params);
    if (s == OK) s = params_take(params, f, path);
    *out = s == OK ? params : NULL;
    if (s != OK) nn_params_free(params);
    return s;
}

static status take_shared(nn_params *params, const safetensors_file *f, const char *path)
{
    size_t taken = 0;
    for (size_t i = 0; i < params->count; i++) {
        const nn_param *p = &params->items[i];
        const safetensors_tensor *t = safetensors_find(f, p->name);
        if (!t || !is_of_shape(t, p) || t->type == SAFETENSORS_I64) continue;
        status s = safetensors_to_float(t, p->value);
        if (s != OK) return fail_in(s, "%s: tensor %s", path, p->name);
        taken++;
    }
    if (taken == 0) return fail(MERLIN_BAD_INPUT, "%s: no tensor fits the model", path);
    nn_params_touch(params);
    return OK;
}

static status load(nn_params *params, const char *path,
                   status (*take)(nn_params *, const safetensors_file *, const char *))
{
    safetensors_file *f;
    status s = safetensors_open(path, &f);
    if (s != OK) return s;
    s = take(params, f, path);
    safetensors_close(f);
    return s;
}

status nn_params_load_shared(nn_params *params, const char *path)
{
    return load(params, path, take_shared);
}

status nn_params_load(nn_params *params, const char *path)
{
    return load(params, path, params_take);
}
