/* SPDX-License-Identifier: MIT */
/* Implements merlin_near_network and merlin_stereo_by_network of include/merlin/stereo.h. */
#include <stdlib.h>

#include "base/api_needs.h"
#include "merlin/stereo.h"
#include "nfps/nfps_stereo.h"
#include "stereo/guided.h"

struct merlin_near_network {
    nfps_network *network;
};

merlin_status merlin_near_network_open(const char *weights, merlin_near_network **out)
{
    if (out) *out = NULL;
    status s = api_needs(__func__, weights && out);
    if (s != OK) return s;
    merlin_near_network *n = calloc(1, sizeof *n);
    if (!n) return fail(MERLIN_NO_MEMORY, "no memory for a model");
    s = nfps_network_open(weights, &n->network);
    if (s == OK)
        *out = n;
    else
        merlin_near_network_close(n);
    return s;
}

void merlin_near_network_close(merlin_near_network *network)
{
    if (!network) return;
    nfps_network_close(network->network);
    free(network);
}

merlin_status merlin_stereo_by_network(const merlin_near_network *network, const merlin_capture *capture,
                                       const merlin_stereo_params *params, merlin_surface *out)
{
    if (out) *out = (merlin_surface){0};
    status s = api_needs(__func__, capture && out);
    const pst_guide guide = network ? nfps_guide(network->network) : (pst_guide){0};
    return s == OK ? pst_stereo_guided(capture, params, network ? &guide : NULL, out) : s;
}
