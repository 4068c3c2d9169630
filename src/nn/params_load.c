/* Parameters from a safetensors file. */
#include "nn/params.h"
#include "nn/safetensors.h"

static status check_tensor(const nn_param *p, const st_tensor *t, const char *path)
{
    if (!t) return fail(ERROR_INPUT, "%s: tensor %s is missing", path, p->name);
    bool same = t->rank == p->rank;
    for (int i = 0; same && i < p->rank; i++)
        same = t->shape[i] == p->shape[i];
    if (!same) return fail(ERROR_INPUT, "%s: tensor %s has another shape than the model's", path, p->name);
    if (t->type == ST_I64) return fail(ERROR_INPUT, "%s: tensor %s is not of a float type", path, p->name);
    return OK;
}

status nn_params_take(nn_params *params, const st_file *f, const char *path)
{
    for (size_t i = 0; i < params->count; i++) {
        status s = check_tensor(&params->items[i], st_find(f, params->items[i].name), path);
        if (s != OK) return s;
    }
    for (size_t i = 0; i < st_count(f); i++) {
        const char *name = st_at(f, i)->name;
        if (!nn_params_find(params, name))
            return fail(ERROR_INPUT, "%s: the model has no parameter for tensor %s", path, name);
    }
    for (size_t i = 0; i < params->count; i++) {
        status s = st_to_float(st_find(f, params->items[i].name), params->items[i].value);
        if (s != OK) return fail_in(s, "%s: tensor %s", path, params->items[i].name);
    }
    nn_params_touch(params);
    return OK;
}

status nn_params_load(nn_params *params, const char *path)
{
    st_file *f;
    status s = st_open(path, &f);
    if (s != OK) return s;
    s = nn_params_take(params, f, path);
    st_close(f);
    return s;
}
