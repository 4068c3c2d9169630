/* What a program costs, where its time goes, and what the machine can do. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/progress.h"
#include "nn/program.h"

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

static status profile_step(nn_step *step, const char *pass, step_call call, double flops, int runs, FILE *file)
{
    double seconds = INFINITY; /* the best: others may be using the machine */
    for (int r = 0; r < runs; r++) {
        double start = clock_seconds();
        status s = call(step);
        if (s != OK) return fail_in(s, "%s", step->name);
        seconds = fmin(seconds, clock_seconds() - start);
    }
    const nn_tensor *t = op_is_loss(step->op) ? &step->in[0] : &step->out;
    int written = fprintf(file, "%-8s %-18s %-32s %4dx%dx%dx%-4d %9.3f ms %8.1f GFLOP/s\n", pass, op_name(step->op),
                          step->name, t->n, t->h, t->w, t->c, seconds * 1e3, flops / seconds * 1e-9);
    return written > 0 ? OK : fail(ERROR_OUTPUT, "cannot write the profile");
}

static status profile_steps(nn_program *p, int runs, FILE *file)
{
    status s = OK;
    for (int i = 0; s == OK && i < p->step_count; i++) {
        nn_step *step = &p->steps[i];
        s = profile_step(step, "forward", step->run->forward, step->forward_flops, runs, file);
    }
    for (int i = 0; s == OK && i < p->step_count; i++) {
        nn_step *step = &p->steps[i];
        if (step->run->refresh) s = profile_step(step, "refresh", step->run->refresh, 0, runs, file);
    }
    for (int i = p->step_count - 1; s == OK && i >= 0; i--) {
        nn_step *step = &p->steps[i];
        if (step->backs) s = profile_step(step, "backward", step->run->backward, step->backward_flops, runs, file);
    }
    return s;
}

status nn_profile(nn_program *p, int runs, void *file)
{
    if (runs < 1) return fail(ERROR_USAGE, "a profile of %d runs", runs);
    status s = nn_forward(p);
    if (s != OK) return s;
    p->forwarded = false; /* what forward left is not kept for a backward */
    p->device->begin(p->context);
    s = profile_steps(p, runs, file);
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
