/* SPDX-License-Identifier: MIT */
/* Reads arrays of numbers from MATLAB v5 (.mat) and NumPy (.npz) files, with checks of all bounds against damaged and
 * hostile files.
 *
 *     number_array a;
 *     status s = mat_read("Normal_gt.mat", "Normal_gt", &a);      512 x 612 x 3
 *     float n = a.data[array_at(&a, row, column, 2)];
 *     array_free(&a);
 */
#ifndef MERLIN_STEREO_ARRAYS_ARRAY_FILE_H
#define MERLIN_STEREO_ARRAYS_ARRAY_FILE_H

#include <stdbool.h>
#include <stddef.h>

#include "base/status.h"

enum { ARRAY_MOST_DIMENSIONS = 3 };

typedef struct number_array {
    size_t size[ARRAY_MOST_DIMENSIONS]; /* missing dimensions are 1 */
    bool column_major;
    float *data;
} number_array;

static inline size_t array_count(const number_array *a)
{
    return a->size[0] * a->size[1] * a->size[2];
}

static inline size_t array_at(const number_array *a, size_t i, size_t j, size_t k)
{
    return a->column_major ? i + a->size[0] * (j + a->size[1] * k) : (i * a->size[1] + j) * a->size[2] + k;
}

void array_free(number_array *a);

/* Reads a variable of a MATLAB v5 file (little endian; plain or compressed; real numbers of any class). */
status mat_read(const char *path, const char *variable, number_array *out);
status mat_parse(const char *bytes, size_t size, const char *where, const char *variable, number_array *out);

/* Reads a member ("zgt" or "zgt.npy") of a NumPy .npz (stored or deflated; little-endian floats and integers). */
status npz_read(const char *path, const char *member, number_array *out);
status npz_parse(const char *bytes, size_t size, const char *where, const char *member, number_array *out);

#endif
