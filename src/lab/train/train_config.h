/* SPDX-License-Identifier: MIT */
/* Configuration of `merlin-lab train`: {"model": {...}, "training": {...}}, one file per stage in configs/runs. */
#ifndef MERLIN_LAB_TRAIN_TRAIN_CONFIG_H
#define MERLIN_LAB_TRAIN_TRAIN_CONFIG_H

#include "model/model.h"

typedef struct train_config {
    int size;                  /* of the square samples, pixels; a multiple of 32 */
    int batch;                 /* presentations a step */
    int presentations;         /* in all; one epoch is one presentation of every training sample */
    double learning_rate;      /* of decoders and global-illumination network, before halving */
    double encoder_rate_scale; /* the encoder's share of it */
    double halve_every_epochs; /* may be a fraction; 0: never */
    int warmup_steps;          /* the rate rises linearly over so many steps */
    double beta1, beta2, clip_norm;
    double depth_weight; /* of the depth loss; the paper's is 1 */
    nn_type type;        /* "f32", "bf16", or "auto", the faster of them on this machine */
    int seed;
    double exposure_jitter; /* half-width of the uniform exposure error, natural logarithm */
    double colour_jitter;   /* the same, each channel on its own */
    /* More faults of photographs; each may be left out of the file and is 0 then, none: */
    double camera_turn;     /* pan, tilt and roll of the camera, at most so many degrees each */
    double distance_jitter; /* half-width of the uniform logarithm of distance and size (train/motion.h) */
    double background_leak; /* share of photographs with a background, which shows at the outline */
    double outline_error;   /* share whose mask is a pixel too large or too small */
    double jpeg;            /* share compressed as JPEG */
    double perfect_camera;  /* share of photographs as the paper's: only turned and moved, saturated at radiance 1 */
    /* Optional, too: */
    double albedo_weight;       /* of the albedo loss; left out, 1, as the paper's */
    double relight_brdf_weight; /* of a loss for relighting by the maps' BRDF beside the network's; 0: none, as the
                                   paper */
    double ssim_weight;   /* of structural dissimilarity of the relit images, by network and by BRDF; 0: none, as the
                             paper (docs/notes/similarity_in_training.md) */
    double dark_target;   /* setting B: share of the targets without an environment */
    double average_decay; /* of the weights' mean (train/average.h), which is validated and exported; 0: the last */
    double memory_gib;    /* samples beyond this are read from disk each time */
    int validation_count; /* the folder's last samples are held back; a multiple of batch */
    int validation_steps; /* between validations; 0: one, behind the last step, and no weights before */
    int curve_steps;      /* a row of curves.csv is the mean over so many */
    double checkpoint_minutes;
} train_config;

/* Every key is required but those said to be optional, unknown ones are refused; messages name the key. */
status train_config_parse(const char *json, size_t size, const char *where, model_config *model,
                          train_config *training);
/* The same from a file, with those that it names (base/text/json_file.h); "model" may be a path. */
status train_config_read(const char *path, model_config *model, train_config *training);
/* The "training" object as JSON, malloc'ed: equal text means equal training; optional keys are in it unless they are as
 * if left out. NULL if memory ran out. */
char *train_config_write(const train_config *c);

#endif
