/* SPDX-License-Identifier: MIT */
/* Configuration of `merlin-lab train`: {"model": {...}, "training": {...}}, one file per training stage in
 * configs/runs. */
#ifndef MERLIN_LAB_TRAIN_CONFIG_TRAIN_CONFIG_H
#define MERLIN_LAB_TRAIN_CONFIG_TRAIN_CONFIG_H

#include "model/model.h"

typedef struct train_config {
    int size;                  /* of the square samples, pixels; a multiple of 32 */
    int batch;                 /* presentations a step */
    int presentations;         /* in total; one epoch is one presentation of every training sample */
    double learning_rate;      /* of decoders and global-illumination network, before halving */
    double encoder_rate_scale; /* ratio of the encoder's rate to it */
    double halve_every_epochs; /* may be a fraction; 0: never */
    int warmup_steps;          /* steps over which the rate rises linearly */
    double beta1, beta2, clip_norm;
    double depth_weight; /* of the depth loss; 1 in the paper */
    nn_type type;        /* "f32", "bf16", or "auto", the faster of them on this machine */
    int seed;
    double exposure_jitter; /* half-width of the uniform exposure error, natural logarithm */
    double colour_jitter;   /* the same for each channel on its own */
    /* Optional faults of photographs, 0 by default: */
    double camera_turn;     /* largest pan, tilt and roll of the camera, degrees each */
    double distance_jitter; /* half-width of the uniform logarithm of distance and size (train/samples/motion.h) */
    double background_leak; /* share of photographs with a background, which shows at the outline */
    double outline_error;   /* share whose mask is dilated or eroded by a pixel */
    double jpeg;            /* share compressed as JPEG */
    double perfect_camera;  /* share of photographs as in the paper: only turned and moved, saturated at radiance 1 */
    /* Other optional settings: */
    double albedo_weight;       /* of the albedo loss; by default 1, as in the paper */
    double relight_brdf_weight; /* of a loss for relighting by the maps' BRDF besides the network's; 0: none, as in the
                                 * paper */
    double ssim_weight; /* of the structural dissimilarity of relit images, by network and by BRDF; 0: none, as in the
                         * paper (docs/notes/similarity_in_training.md) */
    double dark_target; /* setting B: share of targets without an environment */
    double fewest_pictures, most_pictures; /* of an object at once; each step has a number of them that divides a rank's
                                            * batch. 1 unless the model takes several */
    double single_rate_scale; /* ratio of the rate of parameters that the model of one photograph has, too, to that of
                               * those which only a model of several has; 1 by default */
    double lamp_weight;       /* of the loss for the strongest lamp's direction; 0.25 by default */
    /* Shares of photographs under any light that are by a flash alone (a third by default), by a flash in a room, and
     * by one lamp in the dark (both 0 by default, apart from those that are mixed so by chance): */
    double flash_alone, flash_in_room, lamp_alone;
    double weight_decay;  /* of convolutions and fully connected layers, decoupled (nn_adam_options) */
    double average_decay; /* of the weights' mean (train/average.h), which is validated and exported; 0: the last
                           * weights are */
    double memory_gib;    /* samples beyond this are read from disk each time */
    int validation_count; /* number of the folder's last samples that are for validation; a multiple of batch */
    int validation_steps; /* between validations; 0: one after the last step, and no weights before */
    int curve_steps;      /* number of steps whose mean is a row of curves.csv */
    double checkpoint_minutes;
} train_config;

/* Parses a configuration. Every key except the optional ones is required, unknown ones are refused; messages name the
 * key. */
status train_config_parse(const char *json, size_t size, const char *where, model_config *model,
                          train_config *training);
/* Reads a file, with those that it refers to (base/text/json_file.h); "model" may be a path. */
status train_config_read(const char *path, model_config *model, train_config *training);
/* Returns the "training" object as JSON, malloc'ed: equal text means equal training; optional keys are written if they
 * differ from their defaults. NULL if memory ran out. */
char *train_config_write(const train_config *c);

#endif
