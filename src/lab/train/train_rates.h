/* SPDX-License-Identifier: MIT */
/* The rates of a model's parts as shares of the training's rate. */
#ifndef MERLIN_LAB_TRAIN_TRAIN_RATES_H
#define MERLIN_LAB_TRAIN_TRAIN_RATES_H

#include "lab/train/config/train_config.h"
#include "nn/nn.h"

/* Applies "encoder_rate_scale" to the encoder and "single_rate_scale" to what the model of one photograph has, too;
 * both to the encoder of the latter. MERLIN_NO_MEMORY. */
status train_rates_set(const model_config *model, const train_config *c, nn_params *params);

#endif
