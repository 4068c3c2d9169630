/* SPDX-License-Identifier: MIT */
/* A model's configuration, and its JSON form. */
#ifndef MERLIN_MODEL_MODEL_CONFIG_H
#define MERLIN_MODEL_MODEL_CONFIG_H

#include <stdbool.h>
#include <stddef.h>

#include "base/status.h"

enum { MODEL_LEVELS = 5, MODEL_SH = 27 };

typedef enum model_relight { MODEL_RELIGHT_NETWORK, MODEL_RELIGHT_BRDF } model_relight;
typedef enum model_lighting { MODEL_LIGHT_POINT, MODEL_LIGHT_BOTH, MODEL_LIGHT_ANY } model_lighting;

/* The paper's rivals (model/rivals/rival.h): Li et al. 2018, Sang and Chandraker 2020. */
typedef enum model_rival { MODEL_NO_RIVAL, MODEL_LI, MODEL_SANG } model_rival;

typedef struct model_config {
    char name[64];
    model_rival rival;     /* a rival's network in place of MERLiN's: only "cascades" is its choice */
    int cascades;          /* number of a rival's refining stages, 0 to 2 */
    int nfps_width;        /* > 0: the network of near lights (model/nfps.h), of so many channels; its only choice */
    bool input_global;     /* the input has indirect light (the paper's Img-g), or direct light only (Img-d) */
    int material_decoders; /* 1 or 4 */
    bool feature_sharing;  /* the relighting decoder gets the material decoder's features */
    bool gated_attention;
    model_relight relight; /* by network: has a relighting decoder */
    bool global_illumination;
    /* the paper's settings A (point) and B (point and environment), or any light and lens */
    model_lighting lighting;
    bool several;     /* takes several pictures of the object at once, each in its own light ("lighting": "any" only) */
    bool only_lights; /* has nothing but the encoder and what says each picture's light ("lighting": "any" only) */
    int widths[MODEL_LEVELS]; /* channels at 1/2, 1/4, 1/8, 1/16, 1/32 of the size */
    int gi_widths[MODEL_LEVELS];
    int encoder_blocks[MODEL_LEVELS];      /* residual blocks after each level's convolutions */
    int material_blocks[MODEL_LEVELS - 1]; /* residual blocks after each level of the material decoders */
} model_config;

/* Parses JSON. Every key is required except the two of blocks (0 if left out), "several" and "only_lights" (false),
 * unknown keys are refused, values are range-checked; messages name the key. A file with "rival" has that, "name" and
 * "cascades" alone, one with "nfps_width" that and "name". */
status model_config_parse(const char *json, size_t size, const char *where, model_config *out);
/* Reads a file like configs/models/NAME.json, or the "model" of one like configs/runs/NAME/01-96.json, with the files
 * that it refers to (base/text/json_file.h). */
status model_config_read(const char *path, model_config *out);
/* Returns malloc'ed JSON that model_config_parse can read; NULL if memory ran out. */
char *model_config_write(const model_config *config);

#endif
