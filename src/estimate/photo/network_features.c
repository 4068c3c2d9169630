/* SPDX-License-Identifier: MIT */
/* The relighting decoder: features of a photograph, and the photograph under another light. */
#include <stdlib.h>

#include "estimate/photo/network.h"
#include "estimate/photo/network_parts.h"
#include "estimate/photo/view.h"
#include "optics/orientation.h"

struct network_features {
    img photo, mask; /* photo: for a rival, whose stages all relight; else empty */
    int count;
    view_features views[ORIENTATIONS]; /* empty for a rival */
};

static const char *const relit_outputs[] = {"relit_direct", NULL};

static status extract_features(network *n, const network_subject *at, int view, view_features *out)
{
    status s = network_run_view(n, at, view, model_features, &n->features);
    return s == OK ? view_features_take(n->features.program, &n->config, at->photo->width, out) : s;
}

status network_features_new(network *n, const img *photo, const img *mask, const sight *how, int views,
                            network_features **out)
{
    const network_subject at = {photo, mask, how};
    *out = NULL;
    if (network_check_views(views) != OK) return MERLIN_WRONG_USE;
    if (n->config.relight != MODEL_RELIGHT_NETWORK)
        return fail(MERLIN_WRONG_USE, "model \"%s\" has no relighting decoder; relight by BRDF", n->config.name);
    network_features *seen = calloc(1, sizeof *seen);
    if (!seen) return fail(MERLIN_NO_MEMORY, "no memory for what the network sees");
    seen->count = views;
    const bool rival = n->config.rival != MODEL_NO_RIVAL;
    status s = img_copy(&seen->mask, mask);
    if (s == OK && rival) s = img_copy(&seen->photo, photo);
    pthread_mutex_lock(&n->lock);
    for (int view = 0; view < views && s == OK && !rival; view++)
        s = extract_features(n, &at, view, &seen->views[view]);
    pthread_mutex_unlock(&n->lock);
    if (s != OK)
        network_features_free(seen);
    else
        *out = seen;
    return s;
}

void network_features_free(network_features *features)
{
    if (!features) return;
    for (int view = 0; view < features->count; view++)
        view_features_free(&features->views[view]);
    img_free(&features->photo);
    img_free(&features->mask);
    free(features);
}

/* Relights in one orientation, and adds the result to the mean. */
static status relight_view(network *n, const network_features *features, const illumination *light, int view, img *mean)
{
    img relit = {0};
    const bool rival = n->config.rival != MODEL_NO_RIVAL;
    status s = network_compile(n, rival ? MODEL_WHOLE : MODEL_RELIGHT, relit_outputs, mean->width, &n->relit);
    if (s != OK) return s;
    nn_program *p = n->relit.program;
    if (rival)
        view_put_photo(p, 0, view, &features->photo);
    else
        view_features_put(&features->views[view], p, 0);
    view_put_mask(p, 0, view, &features->mask);
    view_put_light(p, &n->config, 0, view, light);
    s = nn_forward(p);
    if (s == OK) s = network_take(p, "relit_direct", mean->width, 3, 1, 0, &relit);
    if (s == OK) view_add(mean, &relit, view, 1.0f / (float)features->count);
    img_free(&relit);
    return s;
}

status network_relight(network *n, const network_features *features, const illumination *light, img *direct)
{
    *direct = (img){0};
    if (light->sh && n->config.lighting != MODEL_LIGHT_BOTH)
        return fail(MERLIN_WRONG_USE,
                    "model \"%s\" relights by point lights only, not by environments; relight by BRDF", n->config.name);
    pthread_mutex_lock(&n->lock);
    status s = img_new(direct, features->mask.width, features->mask.height, 3);
    for (int view = 0; view < features->count && s == OK; view++)
        s = relight_view(n, features, light, view, direct);
    pthread_mutex_unlock(&n->lock);
    if (s != OK) img_free(direct);
    return s;
}
