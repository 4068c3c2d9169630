/* SPDX-License-Identifier: MIT */
/* Configurations from arbitrary bytes: whatever is accepted must be within range and survive being written and read. */
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "lab/train/config/train_config.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    model_config model, model_again;
    train_config training;
    if (train_config_parse((const char *)data, size, "fuzz", &model, &training) != OK) return 0;
    if (training.size % MODEL_SIZE_MULTIPLE || training.batch < 1 || training.validation_count % training.batch)
        abort();
    char *text = model_config_write(&model);
    if (!text || model_config_parse(text, strlen(text), "fuzz", &model_again) != OK) abort();
    free(text);
    return 0;
}
