/* SPDX-License-Identifier: MIT */
/* Measures the cost of a program, where its time goes, and the machine's peak. */
#include <math.h>
#include <string.h>

#include "base/progress.h"
#include "nn/nn_program.h"

nn_cost nn_program_cost(const nn_program *p)
{
    nn_cost cost = {.activation_bytes = p->arena_bytes, .workspace_bytes = p->own_bytes};
    for (int i = 0; i < p->step_count; i++) {
        cost.forward_flops += p->steps[i].forward_flops;
        cost.backward_flops += p->steps[i].backward_flops;
    }
    for (size_t i = 0; i < nn_params_count(p->params); i++) {
        const nn_param *param = nn_params_at(p->params, i);
        if (!param->gradient) continue;
        cost.parameter_count += param->count;
        cost.parameter_bytes += param->count * (param->half ? sizeof *param->half : sizeof *param->value);
    }
    return cost;
}

typedef status (*step_call)(nn_step *step);

typedef struct layer_watch {
    int runs;
    nn_layer_seen *seen;
    void *context;
} layer_watch;

static status measure_step(nn_step *step, const char *pass, step_call call, double flops, const layer_watch *w)
{
    double seconds = INFINITY;
    for (int r = 0; r < w->runs; r++) {
        double start = clock_seconds();
        status s = call(step);
        if (s != OK) return fail_in(s, "%s", step->name);
        seconds = fmin(seconds, clock_seconds() - start);
    }
    const nn_tensor *t = op_is_loss(step->op) ? &step->in[0] : &step->out;
    nn_layer layer = {pass, op_name(step->op), step->name, t->n, t->h, t->w, t->c, seconds, flops};
    return w->seen(w->context, &layer);
}

static status measure_steps(nn_program *p, const layer_watch *w)
{
    status s = OK;
    for (int i = 0; s == OK && i < p->step_count; i++) {
        nn_step *step = &p->steps[i];
        s = measure_step(step, "forward", step->run->forward, step->forward_flops, w);
    }
    for (int i = 0; s == OK && i < p->step_count; i++) {
        nn_step *step = &p->steps[i];
        if (step->run->refresh) s = measure_step(step, "refresh", step->run->refresh, 0, w);
    }
    for (int i = p->step_count - 1; s == OK && i >= 0; i--) {
        nn_step *step = &p->steps[i];
        if (step->backs) s = measure_step(step, "backward", step->run->backward, step->backward_flops, w);
    }
    return s;
}

status nn_measure_layers(nn_program *p, int runs, nn_layer_seen *seen, void *context)
{
    if (runs < 1) return fail(MERLIN_WRONG_USE, "layers measured by %d runs", runs);
    status s = nn_forward(p);
    if (s != OK) return s;
    p->forwarded = false; /* forward's results are no longer there for a backward pass */
    p->device->begin(p->context);
    s = measure_steps(p, &(layer_watch){runs, seen, context});
    p->device->end(p->context);
    return s;
}

nn_type nn_fastest_type(void)
{
    return cpu_device()->fastest_type();
}

status nn_measure_peak(nn_type type, nn_peak *out)
{
    const nn_device *device = cpu_device();
    void *context;
    status s = device->open(&context);
    if (s != OK) return s;
    device->begin(context);
    s = device->measure_peak(context, device->usable_type(type), out);
    device->end(context);
    device->close(context);
    return s;
}
