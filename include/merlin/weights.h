/* SPDX-License-Identifier: MIT */
/* merlin/weights: the content of a weights file, and the cost of its network.
 *
 *     merlin_weights weights;
 *     if (merlin_weights_read("merlin-any.safetensors", &weights)) fprintf(stderr, "%s\n", merlin_error());
 *     printf("%s: %zu parameters, %.1f GMAC\n", weights.name, weights.parameters, weights.gmac);
 *     merlin_weights_free(&weights);
 *
 * merlin/model.h opens such a file for use. */
#ifndef MERLIN_WEIGHTS_H
#define MERLIN_WEIGHTS_H

#include <merlin/status.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Side in pixels of the picture to which merlin_weights.gmac refers. */
enum { MERLIN_COST_SIDE = 256 };

typedef struct merlin_tensor {
    const char *name; /* such as "encoder.conv1.weight" */
    const char *type; /* type of its numbers, as the file names it: "F16", "F32", "BF16" or "I64" */
    int rank;         /* number of dimensions, at most 4 */
    int64_t shape[4];
} merlin_tensor;

typedef struct merlin_weights {
    char name[64];     /* name of the model */
    size_t parameters; /* number of trained values */
    size_t statistics; /* number of running means and variances of batch norms */
    double gmac;       /* 10^9 multiplications and additions for one picture */
    size_t tensor_count;
    merlin_tensor *tensors; /* tensors in the file's order */
    void *file;             /* used by the library */
} merlin_weights;

/* Reads a weights file. MERLIN_BAD_INPUT if it is not one. */
merlin_status merlin_weights_read(const char *path, merlin_weights *out);
/* Returns the file's metadata of a name: "config", the network's configuration as JSON, which every file has; those
 * that merlin-lab train adds, such as "samples", "presentations", "validation_loss", "note" and "training" (JSON about
 * its training); NULL if there is none. It is valid as long as the weights. */
const char *merlin_weights_metadata(const merlin_weights *weights, const char *name);
void merlin_weights_free(merlin_weights *weights);

#ifdef __cplusplus
}
#endif

#endif
