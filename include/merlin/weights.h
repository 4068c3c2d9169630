/* SPDX-License-Identifier: MIT */
/* merlin/weights: what is in a weights file, and what its network costs.
 *
 *     merlin_weights weights;
 *     if (merlin_weights_read("merlin-any.safetensors", &weights)) fprintf(stderr, "%s\n", merlin_error());
 *     printf("%s: %zu parameters, %.1f GMAC\n", weights.name, weights.parameters, weights.gmac);
 *     merlin_weights_free(&weights);
 *
 * merlin/model.h opens such a file to work with it. */
#ifndef MERLIN_WEIGHTS_H
#define MERLIN_WEIGHTS_H

#include <merlin/status.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The side of the picture that merlin_weights.gmac is of, in pixels. */
enum { MERLIN_COST_SIDE = 256 };

typedef struct merlin_tensor {
    const char *name; /* such as "encoder.conv1.weight" */
    const char *type; /* of its numbers, as the file calls it: "F16", "F32", "BF16" or "I64" */
    int rank;         /* at most 4 */
    int64_t shape[4];
} merlin_tensor;

typedef struct merlin_weights {
    char name[64];     /* the model's */
    size_t parameters; /* trained numbers */
    size_t statistics; /* running means and variances of batch norms */
    double gmac;       /* 10^9 multiplications and additions for one picture */
    size_t tensor_count;
    merlin_tensor *tensors; /* in the file's order */
    void *file;             /* the library's own */
} merlin_weights;

/* Reads a weights file. MERLIN_BAD_INPUT for what is none. */
merlin_status merlin_weights_read(const char *path, merlin_weights *out);
/* Returns what the file says of itself under a name: "config", the network's configuration as JSON, which every file
 * has; what merlin-lab train adds, such as "samples", "presentations", "validation_loss", "note" and "training" (JSON
 * again, how it was trained); NULL without. It lives as long as the weights. */
const char *merlin_weights_metadata(const merlin_weights *weights, const char *name);
void merlin_weights_free(merlin_weights *weights);

#ifdef __cplusplus
}
#endif

#endif
