/* SPDX-License-Identifier: MIT */
/* Compilation: lowered steps become device steps with memory. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "nn/lower.h"
#include "nn/nn_program.h"
#include "nn/weights_ahead.h"

/* State of a compilation. Time runs 0 .. n-1 through the forward steps and n .. 2n-1 backward through the same steps.
 */
typedef struct compilation {
    lowering low;
    nn_program *program;
    plan_buffer *buffers;
    int buffer_count;
    int *step_buffers; /* two a step: forward scratch, backward scratch */
} compilation;

static int backward_time(const compilation *c, int step)
{
    return 2 * c->low.step_count - 1 - step;
}

/* Returns the value that is a step's k-th input. */
static lowered_value *input_of(const compilation *c, int step, int k)
{
    const lowered_step *from = &c->low.steps[step];
    const lowered_value *head = &c->low.values[from->head];
    return &c->low.values[k < head->node->inputs ? head->in[k] : from->beside];
}

static status fill_step(compilation *c, int index)
{
    const lowered_step *from = &c->low.steps[index];
    const lowered_value *values = c->low.values, *head = &values[from->head], *result = &values[from->result];
    nn_step *step = &c->program->steps[index];
    bool train = c->low.options.purpose == NN_TRAIN;
    *step = (nn_step){.op = head->node->op,
                      .at = head->node->at,
                      .compute = c->low.options.type,
                      .filtering = c->low.options.filtering,
                      .train = train,
                      .group = c->low.options.group > 0 ? c->low.options.group : 1,
                      .momentum = NN_NORM_MOMENTUM,
                      .relu = from->relu,
                      .inputs = head->node->inputs + (from->beside >= 0),
                      .out = result->tensor,
                      .out_gradient = result->tensor,
                      .context = c->program->context,
                      .together = c->low.options.together};
    char name[300];
    if (head->node->name)
        snprintf(name, sizeof name, "%s", head->node->name);
    else
        snprintf(name, sizeof name, "%s.%d", op_name(step->op), from->head);
    step->name = strdup(name);
    if (!step->name) return fail(MERLIN_NO_MEMORY, "no memory for a step");
    for (int k = 0; k < step->inputs; k++) {
        const lowered_value *x = input_of(c, index, k);
        step->in[k] = step->in_gradient[k] = x->tensor;
        step->wants[k] = x->differentiable && op_passes_gradient(head->node->op, k);
    }
    step->backs = train && (op_is_loss(step->op) ? step->wants[0] : result->differentiable);
    status s = params_of_node(c->program->params, head->node, &step->params);
    if (s == OK && from->norm >= 0) s = params_of_node(c->program->params, values[from->norm].node, &step->folded);
    return s;
}

static status create_steps(compilation *c)
{
    nn_program *p = c->program;
    p->steps = calloc((size_t)c->low.step_count + 1, sizeof *p->steps);
    if (!p->steps) return fail(MERLIN_NO_MEMORY, "no memory for %d steps", c->low.step_count);
    for (int i = 0; i < c->low.step_count; i++) {
        p->step_count = i + 1;
        status s = fill_step(c, i);
        if (s == OK) s = p->device->create(&p->steps[i]);
        if (s != OK) return fail_in(s, "%s", p->steps[i].name ? p->steps[i].name : "step");
        p->own_bytes += p->steps[i].own_bytes;
    }
    return OK;
}

/* Decides which steps write a gradient and which add to it: the first write, the others add. */
static void order_gradients(compilation *c)
{
    bool *written = (bool *)c->step_buffers; /* borrowed until the buffers are planned */
    memset(written, 0, (size_t)c->low.graph->count);
    for (int i = c->low.step_count - 1; i >= 0; i--) {
        nn_step *step = &c->program->steps[i];
        const lowered_value *head = &c->low.values[c->low.steps[i].head];
        for (int k = 0; step->backs && k < step->inputs; k++) {
            if (!step->wants[k]) continue;
            step->accumulate[k] = written[head->in[k]];
            written[head->in[k]] = true;
        }
    }
}

static int add_buffer(compilation *c, size_t bytes, int time)
{
    c->buffers[c->buffer_count] = (plan_buffer){.bytes = bytes, .first = time, .last = time};
    return c->buffer_count++;
}

/* Makes sure that a buffer exists and is alive at this time. */
static void use_buffer(compilation *c, int *buffer, size_t bytes, int time)
{
    if (*buffer < 0) *buffer = add_buffer(c, bytes, time);
    plan_buffer *b = &c->buffers[*buffer];
    if (time < b->first) b->first = time;
    if (time > b->last) b->last = time;
}

static void use_values(compilation *c, int i)
{
    const nn_step *step = &c->program->steps[i];
    const lowered_step *from = &c->low.steps[i];
    lowered_value *values = c->low.values, *result = &values[from->result];
    int back = backward_time(c, i);
    for (int k = 0; k < step->inputs; k++) {
        lowered_value *x = input_of(c, i, k);
        use_buffer(c, &x->buffer, tensor_bytes(&x->tensor), i);
        if (!step->backs) continue;
        if (step->reads_in) use_buffer(c, &x->buffer, 0, back);
        if (step->wants[k]) use_buffer(c, &x->gradient_buffer, tensor_bytes(&x->tensor), back);
    }
    if (op_is_loss(step->op)) return;
    use_buffer(c, &result->buffer, tensor_bytes(&result->tensor), i);
    if (step->backs && step->reads_out) use_buffer(c, &result->buffer, 0, back);
    if (step->backs) use_buffer(c, &result->gradient_buffer, tensor_bytes(&result->tensor), back);
}

static void use_step_memory(compilation *c, int i)
{
    const nn_step *step = &c->program->steps[i];
    int *forward = &c->step_buffers[2 * i], *backward = forward + 1;
    *forward = *backward = -1;
    if (step->forward_scratch) use_buffer(c, forward, step->forward_scratch, i);
    if (step->backs && step->backward_scratch) use_buffer(c, backward, step->backward_scratch, backward_time(c, i));
}

static status take_arena(nn_program *p, const nn_program *beside)
{
    if (beside && beside->arena && beside->arena->bytes >= p->arena_bytes) {
        p->arena = beside->arena;
        p->arena->users++;
        return OK;
    }
    program_arena *a = p->arena = calloc(1, sizeof *a);
    if (a) *a = (program_arena){p->device->allocate(p->arena_bytes + 1), p->arena_bytes, 1};
    return a && a->memory ? OK : fail(MERLIN_NO_MEMORY, "no memory for activations (%zu MB)", p->arena_bytes >> 20);
}

static status plan(compilation *c)
{
    int count = c->low.graph->count, end = 2 * c->low.step_count;
    for (int i = 0; i < count; i++) { /* what the caller fills or reads is alive all the time */
        lowered_value *v = &c->low.values[i];
        if (!v->live || (v->node->op != OP_INPUT && !v->is_output)) continue;
        use_buffer(c, &v->buffer, tensor_bytes(&v->tensor), v->node->op == OP_INPUT ? -1 : end);
        use_buffer(c, &v->buffer, 0, end);
    }
    for (int i = 0; i < c->low.step_count; i++) {
        use_values(c, i);
        use_step_memory(c, i);
    }
    nn_program *p = c->program;
    status s = plan_memory(c->buffers, (size_t)c->buffer_count, &p->arena_bytes);
    return s == OK ? take_arena(p, p->options.beside) : s;
}

static void *address(const compilation *c, int buffer)
{
    return buffer < 0 ? NULL : (char *)c->program->arena->memory + c->buffers[buffer].offset;
}

static bool can_be_trained(const nn_params *params)
{
    return params->halves == NULL;
}

static status bind_step(compilation *c, int i)
{
    nn_step *step = &c->program->steps[i];
    const lowered_step *from = &c->low.steps[i];
    const lowered_value *values = c->low.values, *result = &values[from->result];
    for (int k = 0; k < step->inputs; k++) {
        const lowered_value *x = input_of(c, i, k);
        step->in[k].data = address(c, x->buffer);
        step->in_gradient[k].data = step->backs && step->wants[k] ? address(c, x->gradient_buffer) : NULL;
    }
    step->out.data = address(c, result->buffer);
    step->out_gradient.data = step->backs ? address(c, result->gradient_buffer) : NULL;
    step->forward_space = address(c, c->step_buffers[2 * i]);
    step->backward_space = address(c, c->step_buffers[2 * i + 1]);
    status s = step->run->bind ? step->run->bind(step) : OK;
    return s == OK ? OK : fail_in(s, "%s", step->name);
}

/* Binds the steps, which occupies one thread; another meanwhile converts the weights of steps already bound, unless
 * parameters may still change before the first run. */
static status bind_steps(compilation *c)
{
    weights_ahead ahead = {0};
    status s = OK;
    if (!can_be_trained(c->program->params)) weights_ahead_begin(&ahead, c->program);
    for (int i = 0; s == OK && i < c->low.step_count; i++) {
        s = bind_step(c, i);
        if (s == OK) weights_ahead_bound(&ahead, i + 1);
    }
    return weights_ahead_end(&ahead, s);
}

/* Makes the host's side of an input or output: the device's memory itself if that is float32. */
static status make_port(compilation *c, program_port *port, const char *name, const lowered_value *v)
{
    nn_tensor tensor = v->tensor;
    tensor.data = address(c, v->buffer);
    *port = (program_port){.name = strdup(name), .device = tensor, .host = tensor.data};
    if (!tensor.data || tensor.type != NN_FLOAT32) {
        port->owned = true;
        port->host = c->program->device->allocate(tensor_count(&tensor) * sizeof(float));
    }
    return port->name && port->host ? OK : fail(MERLIN_NO_MEMORY, "no memory for \"%s\"", name);
}

static status make_ports(compilation *c)
{
    nn_program *p = c->program;
    const nn_graph *g = c->low.graph;
    p->inputs = calloc((size_t)g->count + 1, sizeof *p->inputs);
    p->outputs = calloc((size_t)g->output_count + 1, sizeof *p->outputs);
    if (!p->inputs || !p->outputs) return fail(MERLIN_NO_MEMORY, "no memory for inputs and outputs");
    status s = OK;
    for (int i = 0; s == OK && i < g->count; i++)
        if (g->nodes[i]->op == OP_INPUT)
            s = make_port(c, &p->inputs[p->input_count++], g->nodes[i]->name, &c->low.values[i]);
    for (int i = 0; s == OK && i < g->output_count; i++) {
        if (!lower_wants_output(&c->low.options, g->outputs[i].name)) continue;
        int node = lower_resolve(c->low.options.type, g->outputs[i].node);
        s = make_port(c, &p->outputs[p->output_count++], g->outputs[i].name, &c->low.values[node]);
    }
    return s;
}

static status find_untouched(nn_program *p)
{
    size_t count = nn_params_count(p->params);
    p->untouched = malloc(count + 1);
    if (!p->untouched) return fail(MERLIN_NO_MEMORY, "no memory for a program");
    memset(p->untouched, 1, count);
    for (int i = 0; i < p->step_count; i++) {
        const nn_step *step = &p->steps[i];
        if (!step->backs) continue;
        if (step->params.weight) p->untouched[step->params.weight - nn_params_at(p->params, 0)] = false;
        if (step->params.bias) p->untouched[step->params.bias - nn_params_at(p->params, 0)] = false;
    }
    return OK;
}

static status build(compilation *c, const nn_graph *g, const nn_options *options)
{
    nn_program *p = c->program;
    status s = lower_graph(g, options, &c->low);
    if (s == OK) s = p->device->open(&p->context);
    if (s == OK) s = create_steps(c);
    if (s != OK) return s;
    /* a value and its gradient for each node, two for each step */
    c->buffers = calloc((size_t)g->count * 4 + 1, sizeof *c->buffers);
    c->step_buffers = calloc((size_t)g->count * 2 + 1, sizeof *c->step_buffers);
    if (!c->buffers || !c->step_buffers) return fail(MERLIN_NO_MEMORY, "no memory to compile %d nodes", g->count);
    order_gradients(c);
    s = plan(c);
    if (s == OK) s = bind_steps(c);
    if (s == OK) s = make_ports(c);
    if (s == OK) s = find_untouched(p);
    return s;
}

status nn_compile(const nn_graph *g, nn_params *params, const nn_options *options, nn_program **out)
{
    *out = NULL;
    if (options->purpose == NN_TRAIN && !can_be_trained(params))
        return fail(MERLIN_WRONG_USE, "parameters of nn_params_open are not for training");
    nn_program *p = calloc(1, sizeof *p);
    if (!p) return fail(MERLIN_NO_MEMORY, "no memory for a program");
    p->device = cpu_device();
    p->params = params;
    p->options = *options;
    p->options.type = p->device->usable_type(options->type);
    compilation c = {.program = p};
    status s = build(&c, g, &p->options);
    free(c.buffers);
    free(c.step_buffers);
    lowering_free(&c.low);
    p->options.beside = NULL; /* the arguments may be freed before this program */
    p->options.outputs = NULL;
    if (s == OK)
        *out = p;
    else
        nn_program_free(p);
    return s;
}
