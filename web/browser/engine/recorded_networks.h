/* SPDX-License-Identifier: MIT */
/* The networks of a browser, which runs them elsewhere and answers later, for code that waits for their results.
 *
 *     network_value_add("merlin-any/maps", "image", 3, 1, true);     ... and all others, by networks.json
 *     networks_forget();                                             another photograph
 *     while (merlin_estimate(...) == MERLIN_STOPPED && (run = networks_wanted())) {
 *         ... run->network with run->inputs, into run->outputs ...
 *         networks_answered();
 *     }
 *
 * The functions of nn/nn.h that src/estimate calls are implemented here by results that are recorded: the first run
 * whose result is not there yet ends the estimate with MERLIN_STOPPED. Once it is there the estimate is made again
 * from its beginning, and comes one run further. Everything but networks is computed again each time, which costs a
 * twentieth of what they cost. */
#ifndef MERLIN_BROWSER_RECORDED_NETWORKS_H
#define MERLIN_BROWSER_RECORDED_NETWORKS_H

#include <stdbool.h>

#include "nn/nn.h"

enum { NETWORK_VALUES_MOST = 16 };

/* An input or output of one run: channels first, side × side, or a vector, whose side is 1. */
typedef struct network_value {
    char name[32];
    int channels, side;
    float *data;
} network_value;

typedef struct network_run {
    const char *network; /* "merlin-any/maps" */
    int input_count, output_count;
    network_value inputs[NETWORK_VALUES_MOST], outputs[NETWORK_VALUES_MOST];
} network_run;

/* Adds an input or output of a network. reduction: as in networks.json, 0 for a vector. */
status network_value_add(const char *network, const char *name, int channels, int reduction, bool is_input);

/* Returns the run that is waited for; NULL: none. Its outputs' data are room for the results. */
network_run *networks_wanted(void);
/* Records its outputs as its results. */
void networks_answered(void);

/* Begins at the first recorded result again: before each call that runs networks. */
void networks_rewind(void);
/* Forgets all results. */
void networks_forget(void);

#endif
