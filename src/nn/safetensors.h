/* SPDX-License-Identifier: MIT */
/* safetensors files: named tensors and string metadata. Reading trusts nothing in the file: every length, offset, type
 * and name is checked, and the header must be the JSON the format defines. */
#ifndef MERLIN_NN_SAFETENSORS_H
#define MERLIN_NN_SAFETENSORS_H

#include "base/status.h"
#include "nn/safetensors_tensor.h"

/* As files call it: "F32". */
const char *st_type_name(st_type type);

typedef struct st_file st_file;

status st_open(const char *path, st_file **out);
/* The same from bytes, which must outlive the file: for the fuzzer. */
status st_parse(const void *bytes, size_t size, st_file **out);
void st_close(st_file *f);
size_t st_count(const st_file *f);
const st_tensor *st_at(const st_file *f, size_t i);
const st_tensor *st_find(const st_file *f, const char *name); /* NULL if absent */
const char *st_metadata(const st_file *f, const char *key);   /* NULL if absent */
/* Converts count elements (any float type) to float32. */
status st_to_float(const st_tensor *t, float *out);

/* Writes tensors (given in their own type's bits) and metadata as key, value pairs; atomically. A CRC-32 of the data is
 * put into the metadata as "crc32" and checked by st_open when present, so that altered weights are refused. */
status st_write(const char *path, const st_tensor *tensors, size_t count, const char *const (*metadata)[2],
                size_t metadata_count);

#endif
