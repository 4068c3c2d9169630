/* SPDX-License-Identifier: MIT */
#include "model/model_config.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/text/json_file.h"

/* Limits. A layer's input is at most three times a width: shared features, upsampled features and the skip. */
enum { MAX_WIDTH = 640, MAX_BLOCKS = 9, MAX_NFPS_WIDTH = 128 };

static const char *const relight_words[] = {"network", "brdf"};
static const char *const lighting_words[] = {"point", "both", "any"};
static const char *const rival_words[] = {"li", "sang"};

static status check_widths(const char *where, const char *key, const int *widths)
{
    /* vector units work on blocks of 8 channels or more, and a gate's inner width is half of its level's */
    for (int i = 0; i < MODEL_LEVELS; i++)
        if (widths[i] % 8) return fail(MERLIN_BAD_INPUT, "%s: \"%s\" must be multiples of 8", where, key);
    return OK;
}

/* Checks a name, which is used unchanged in messages, reports and JSON. */
static status check_name(const char *name, const char *where)
{
    static const char allowed[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789._-";
    if (strspn(name, allowed) == strlen(name)) return OK;
    return fail(MERLIN_BAD_INPUT, "%s: \"name\" may have letters, digits, '.', '_' and '-'", where);
}

/* Reads a rival, and sets what the other keys would say of it. */
static status read_rival(json_object *o, model_config *out)
{
    int rival = 0;
    status s = json_choice(o, "rival", rival_words, 2, &rival);
    if (s == OK) s = json_int(o, "cascades", 0, 2, &out->cascades);
    out->rival = (model_rival)(MODEL_LI + rival);
    out->input_global = true;
    out->material_decoders = out->rival == MODEL_LI ? 4 : 1;
    out->feature_sharing = out->rival == MODEL_SANG;
    out->relight = out->rival == MODEL_SANG ? MODEL_RELIGHT_NETWORK : MODEL_RELIGHT_BRDF;
    out->global_illumination = out->rival == MODEL_LI;
    out->lighting = MODEL_LIGHT_POINT;
    return s;
}

/* Reads the network of near lights. */
static status read_nfps(json_object *o, const char *where, model_config *out)
{
    status s = json_int(o, "nfps_width", 8, MAX_NFPS_WIDTH, &out->nfps_width);
    if (s == OK && out->nfps_width % 8) s = fail(MERLIN_BAD_INPUT, "%s: \"nfps_width\" must be a multiple of 8", where);
    return s;
}

static status read_keys(json_object *o, const char *where, model_config *out)
{
    int relight = 0, lighting = 0;
    status s = json_text(o, "name", out->name, sizeof out->name);
    if (s == OK) s = check_name(out->name, where);
    if (s == OK && json_has(o, "rival")) {
        s = read_rival(o, out);
        return s == OK ? json_finish(o) : s;
    }
    if (s == OK && json_has(o, "nfps_width")) {
        s = read_nfps(o, where, out);
        return s == OK ? json_finish(o) : s;
    }
    if (s == OK) s = json_bool(o, "input_global", &out->input_global);
    if (s == OK) s = json_int(o, "material_decoders", 1, 4, &out->material_decoders);
    if (s == OK && out->material_decoders != 1 && out->material_decoders != 4)
        s = fail(MERLIN_BAD_INPUT, "%s: \"material_decoders\" must be 1 or 4", where);
    if (s == OK) s = json_bool(o, "feature_sharing", &out->feature_sharing);
    if (s == OK) s = json_bool(o, "gated_attention", &out->gated_attention);
    if (s == OK) s = json_choice(o, "relight", relight_words, 2, &relight);
    if (s == OK) s = json_bool(o, "global_illumination", &out->global_illumination);
    if (s == OK) s = json_choice(o, "lighting", lighting_words, 3, &lighting);
    if (s == OK && json_has(o, "several")) s = json_bool(o, "several", &out->several);
    if (s == OK && json_has(o, "only_lights")) s = json_bool(o, "only_lights", &out->only_lights);
    if (s == OK) s = json_ints(o, "widths", 8, MAX_WIDTH, MODEL_LEVELS, out->widths);
    if (s == OK) s = json_ints(o, "gi_widths", 8, MAX_WIDTH, MODEL_LEVELS, out->gi_widths);
    if (s == OK) s = json_ints_or(o, "encoder_blocks", 0, MAX_BLOCKS, MODEL_LEVELS, 0, out->encoder_blocks);
    if (s == OK) s = json_ints_or(o, "material_blocks", 0, MAX_BLOCKS, MODEL_LEVELS - 1, 0, out->material_blocks);
    if (s == OK) s = check_widths(where, "widths", out->widths);
    if (s == OK) s = check_widths(where, "gi_widths", out->gi_widths);
    out->relight = (model_relight)relight;
    out->lighting = (model_lighting)lighting;
    if (s == OK && out->feature_sharing && out->relight != MODEL_RELIGHT_NETWORK)
        s = fail(MERLIN_BAD_INPUT, "%s: \"feature_sharing\" needs \"relight\": \"network\"", where);
    if (s == OK && out->several && (out->lighting != MODEL_LIGHT_ANY || out->relight != MODEL_RELIGHT_BRDF))
        s = fail(MERLIN_BAD_INPUT, "%s: \"several\" needs \"lighting\": \"any\" and \"relight\": \"brdf\"", where);
    if (s == OK && out->only_lights && out->lighting != MODEL_LIGHT_ANY)
        s = fail(MERLIN_BAD_INPUT, "%s: \"only_lights\" needs \"lighting\": \"any\"", where);
    return s == OK ? json_finish(o) : s;
}

status model_config_parse(const char *json, size_t size, const char *where, model_config *out)
{
    memset(out, 0, sizeof *out);
    json_object *o;
    status s = json_parse(json, size, where, &o);
    if (s != OK) return s;
    s = read_keys(o, where, out);
    json_free(o);
    return s;
}

status model_config_read(const char *path, model_config *out)
{
    memset(out, 0, sizeof *out);
    char *inner = NULL;
    json_object *o;
    status s = json_file_read(path, "model", &o);
    if (s != OK) return s;
    if (json_has(o, "name")) {
        s = read_keys(o, json_where(o), out);
    } else {
        s = json_inner(o, "model", &inner);
        if (s == OK) s = model_config_parse(inner, strlen(inner), json_where(o), out);
    }
    json_free(o);
    free(inner);
    return s;
}

static const char *word(bool yes)
{
    return yes ? "true" : "false";
}

char *model_config_write(const model_config *c)
{
    char *text = NULL;
    if (c->rival) {
        int written = asprintf(&text, "{\"name\": \"%s\", \"rival\": \"%s\", \"cascades\": %d}", c->name,
                               rival_words[c->rival - MODEL_LI], c->cascades);
        return written < 0 ? NULL : text;
    }
    if (c->nfps_width) {
        int written = asprintf(&text, "{\"name\": \"%s\", \"nfps_width\": %d}", c->name, c->nfps_width);
        return written < 0 ? NULL : text;
    }
    const int *w = c->widths, *gi = c->gi_widths, *e = c->encoder_blocks, *m = c->material_blocks;
    int length = asprintf(
        &text,
        "{\"name\": \"%s\", \"input_global\": %s, \"material_decoders\": %d, \"feature_sharing\": %s, "
        "\"gated_attention\": %s, \"relight\": \"%s\", \"global_illumination\": %s, "
        "\"lighting\": \"%s\", \"widths\": [%d, %d, %d, %d, %d], \"gi_widths\": [%d, %d, %d, %d, %d], "
        "\"encoder_blocks\": [%d, %d, %d, %d, %d], \"material_blocks\": [%d, %d, %d, %d]%s%s}",
        c->name, word(c->input_global), c->material_decoders, word(c->feature_sharing), word(c->gated_attention),
        relight_words[c->relight], word(c->global_illumination), lighting_words[c->lighting], w[0], w[1], w[2], w[3],
        w[4], gi[0], gi[1], gi[2], gi[3], gi[4], e[0], e[1], e[2], e[3], e[4], m[0], m[1], m[2], m[3],
        c->several ? ", \"several\": true" : "", c->only_lights ? ", \"only_lights\": true" : "");
    return length < 0 ? NULL : text;
}
