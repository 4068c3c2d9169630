/* SPDX-License-Identifier: MIT */
/* Running a program: a loop over its steps. */
#include "nn/nn_program.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static void free_ports(const nn_device *device, program_port *ports, int count)
{
    for (int i = 0; i < count; i++) {
        free(ports[i].name);
        if (ports[i].owned) device->release(ports[i].host);
    }
    free(ports);
}

static void free_arena(const nn_device *device, program_arena *arena)
{
    if (!arena || --arena->users > 0) return;
    device->release(arena->memory);
    free(arena);
}

void nn_program_free(nn_program *p)
{
    if (!p) return;
    for (int i = 0; i < p->step_count; i++) {
        nn_step *step = &p->steps[i];
        if (step->run && step->run->release) step->run->release(step);
        free(step->name);
    }
    free(p->steps);
    free_ports(p->device, p->inputs, p->input_count);
    free_ports(p->device, p->outputs, p->output_count);
    free_arena(p->device, p->arena);
    if (p->context) p->device->close(p->context);
    free(p->untouched);
    free(p);
}

nn_type nn_program_type(const nn_program *p)
{
    return p->options.type;
}

static program_port *find_port(program_port *ports, int count, const char *name)
{
    for (int i = 0; i < count; i++)
        if (strcmp(ports[i].name, name) == 0) return &ports[i];
    return NULL;
}

float *nn_input_data(nn_program *p, const char *name)
{
    program_port *port = find_port(p->inputs, p->input_count, name);
    return port ? port->host : NULL;
}

const float *nn_output_data(nn_program *p, const char *name)
{
    program_port *port = find_port(p->outputs, p->output_count, name);
    return port ? port->host : NULL;
}

status program_refresh_step(nn_step *step)
{
    status s = step->run->refresh ? step->run->refresh(step) : OK;
    return s == OK ? OK : fail_in(s, "%s", step->name);
}

static status refresh(nn_program *p)
{
    if (p->version == p->params->version) return OK;
    for (int i = 0; i < p->step_count; i++) {
        status s = program_refresh_step(&p->steps[i]);
        if (s != OK) return s;
    }
    p->version = p->params->version;
    return OK;
}

static status run_forward(nn_program *p)
{
    status s = refresh(p);
    for (int i = 0; s == OK && i < p->step_count; i++) {
        s = p->steps[i].run->forward(&p->steps[i]);
        if (s != OK) return fail_in(s, "%s", p->steps[i].name);
    }
    for (int i = 0; s == OK && i < p->output_count; i++) {
        const program_port *port = &p->outputs[i];
        nn_tensor host = port->device;
        host.data = port->host;
        host.type = NN_FLOAT32;
        if (host.data != port->device.data) p->device->convert(&port->device, &host);
    }
    return s;
}

status nn_forward(nn_program *p)
{
    p->device->begin(p->context);
    status s = run_forward(p);
    p->device->end(p->context);
    if (s != OK) return s;
    p->forwarded = true;
    /* running statistics have changed: other programs must fold them again, this one holds nothing derived from them */
    if (p->options.purpose == NN_TRAIN) p->version = ++p->params->version;
    return OK;
}

status nn_backward(nn_program *p)
{
    if (p->options.purpose != NN_TRAIN || !p->forwarded)
        return fail(MERLIN_WRONG_USE,
                    "nn_backward needs a program compiled for NN_TRAIN and a forward run before each");
    p->forwarded = false; /* gradients overwrite forward's results */
    for (size_t i = 0; i < nn_params_count(p->params); i++) {
        nn_param *param = nn_params_at(p->params, i);
        if (p->untouched[i] && param->gradient) memset(param->gradient, 0, param->count * sizeof(float));
    }
    status s = OK;
    p->device->begin(p->context);
    for (int i = p->step_count - 1; s == OK && i >= 0; i--) {
        nn_step *step = &p->steps[i];
        if (step->backs) s = step->run->backward(step);
        if (s != OK) s = fail_in(s, "gradient of %s", step->name);
    }
    p->device->end(p->context);
    return s == OK ? ranks_sum_floats(p->options.together, p->params->gradients, p->params->gradient_count) : s;
}

float nn_loss(const nn_program *p, const char *name)
{
    for (int i = 0; i < p->step_count; i++)
        if (op_is_loss(p->steps[i].op) && strcmp(p->steps[i].name, name) == 0) return p->steps[i].loss;
    return NAN;
}

void nn_set_norm_momentum(nn_program *p, float momentum)
{
    for (int i = 0; i < p->step_count; i++)
        p->steps[i].momentum = momentum;
}

void nn_set_loss_weight(nn_program *p, const char *name, float weight)
{
    for (int i = 0; i < p->step_count; i++)
        if (op_is_loss(p->steps[i].op) && strcmp(p->steps[i].name, name) == 0) p->steps[i].at.weight = weight;
}

float nn_total_loss(const nn_program *p)
{
    double total = 0;
    for (int i = 0; i < p->step_count; i++)
        if (op_is_loss(p->steps[i].op)) total += (double)p->steps[i].at.weight * (double)p->steps[i].loss;
    return (float)total;
}
