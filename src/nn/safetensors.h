/* SPDX-License-Identifier: MIT */
/* safetensors files: named tensors and string metadata. The file is not trusted: every length, offset, type and name is
 * checked, and the header must be the JSON that the format defines. */
#ifndef MERLIN_NN_SAFETENSORS_H
#define MERLIN_NN_SAFETENSORS_H

#include "base/status.h"
#include "nn/safetensors_tensor.h"

/* Returns the type's name in files, such as "F32". */
const char *safetensors_type_name(safetensors_type type);

typedef struct safetensors_file safetensors_file;

status safetensors_open(const char *path, safetensors_file **out);
/* Parses a file's bytes, which must outlive it: for the fuzzer. */
status safetensors_parse(const void *bytes, size_t size, safetensors_file **out);
void safetensors_close(safetensors_file *f);
size_t safetensors_count(const safetensors_file *f);
const safetensors_tensor *safetensors_at(const safetensors_file *f, size_t i);
const safetensors_tensor *safetensors_find(const safetensors_file *f, const char *name); /* returns NULL if absent */
const char *safetensors_metadata(const safetensors_file *f, const char *key);            /* returns NULL if absent */
/* Converts count elements (any float type) to float32. */
status safetensors_to_float(const safetensors_tensor *t, float *out);

/* Writes tensors (in the bits of their type) and metadata as key, value pairs, atomically. A CRC-32 of the data is
 * added to the metadata as "crc32"; safetensors_open checks it if present, so that altered weights are refused. */
status safetensors_write(const char *path, const safetensors_tensor *tensors, size_t count,
                         const char *const (*metadata)[2], size_t metadata_count);

#endif
