/* SPDX-License-Identifier: MIT */
/* Builder functions for several pictures of an object. */
#include "nn/graph.h"

nn_node *nn_group_input(nn_graph *g, const char *name, int channels, int reduction)
{
    nn_node *node = nn_input(g, name, channels, reduction);
    if (node) node->of_object = true;
    return node;
}

/* Appends an operation on an object's pictures: x, and which of them are there. */
static nn_node *append_group(nn_graph *g, nn_op op, nn_node *x, nn_node *present)
{
    nn_node *node = graph_append(g, op, (nn_node *[]){x, present}, present ? 2 : 1, false);
    if (!node) return NULL;
    if (x->of_object) return graph_reject(g, "%s: the input is of objects already", op_name(op));
    if (present && (!present->is_float || present->channels != 1 || present->reduction != NN_VECTOR))
        return graph_reject(g, "%s: what says which pictures are there must be a float vector of 1 channel",
                            op_name(op));
    return node;
}

static nn_node *reduce(nn_graph *g, nn_op op, nn_node *x, nn_node *present)
{
    nn_node *node = append_group(g, op, x, present);
    if (node) node->of_object = true;
    return node;
}

nn_node *nn_group_max(nn_graph *g, nn_node *x, nn_node *present)
{
    return reduce(g, OP_GROUP_MAX, x, present);
}

nn_node *nn_group_mean(nn_graph *g, nn_node *x, nn_node *present)
{
    return reduce(g, OP_GROUP_MEAN, x, present);
}

nn_node *nn_group_spread(nn_graph *g, nn_node *x, nn_node *present)
{
    return reduce(g, OP_GROUP_SPREAD, x, present);
}

nn_node *nn_group_repeat(nn_graph *g, nn_node *x)
{
    nn_node *node = graph_append(g, OP_GROUP_REPEAT, &x, 1, false);
    if (!node) return NULL;
    if (!x->of_object) return graph_reject(g, "%s: the input is of pictures already", op_name(node->op));
    node->of_object = false;
    return node;
}

/* Divides the channels among parts (query, key, value) and heads. */
static nn_node *divide(nn_node *node, int parts, int heads)
{
    if (!node) return NULL;
    const int channels = node->channels / parts;
    if (heads < 1 || node->channels % parts || channels % heads || channels / heads > NN_LARGEST_HEAD)
        return graph_reject(node->graph, "%s: %d channels are not %d parts of %d heads of at most %d channels",
                            op_name(node->op), node->channels, parts, heads, NN_LARGEST_HEAD);
    node->at.heads = heads;
    node->channels = channels;
    return node;
}

nn_node *nn_group_attention(nn_graph *g, nn_node *x, nn_node *present, int heads)
{
    return divide(append_group(g, OP_GROUP_ATTENTION, x, present), 3, heads);
}

nn_node *nn_group_pool(nn_graph *g, nn_node *x, nn_node *present, const char *name, int heads)
{
    nn_node *node = divide(reduce(g, OP_GROUP_POOL, x, present), 2, heads);
    return graph_give_name(node, name);
}

nn_node *nn_layer_norm(nn_graph *g, nn_node *x, const char *name)
{
    nn_node *node = graph_append(g, OP_LAYER_NORM, &x, 1, false);
    return graph_give_name(node, name);
}

nn_node *nn_gather(nn_graph *g, nn_node *x, nn_node *places)
{
    nn_node *node = graph_append(g, OP_GATHER, (nn_node *[]){x, places}, 2, true);
    if (!node) return NULL;
    if (x->reduction < 1) return graph_reject(g, "gather: the input is not an image");
    if (!places->is_float || places->channels != 2 || places->reduction != NN_POINTS)
        return graph_reject(g, "gather: places must be float, NN_POINTS, with 2 channels");
    if (x->of_object && !places->of_object)
        return graph_reject(g, "gather: places are of pictures, but the input is of objects");
    node->at.reduction = x->reduction;
    node->reduction = NN_POINTS;
    return node;
}
