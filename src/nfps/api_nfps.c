/* SPDX-License-Identifier: MIT */
/* Implements merlin_near_network and merlin_stereo_by_network of include/merlin/stereo.h. */
#include "base/api_needs.h"
#include "nfps/nfps_stereo.h"
#include "stereo/guided.h"

merlin_status merlin_near_network_open(const char *weights, merlin_near_network **out)
{
    if (out) *out = NULL;
    status s = api_needs(__func__, weights && out);
    return s == OK ? nfps_network_open(weights, out) : s;
}

void merlin_near_network_close(merlin_near_network *network)
{
    nfps_network_close(network);
}

merlin_status merlin_stereo_by_network(const merlin_near_network *network, const merlin_capture *capture,
                                       const merlin_stereo_params *params, merlin_surface *out)
{
    if (out) *out = (merlin_surface){0};
    status s = api_needs(__func__, capture && out);
    const pst_guide guide = nfps_guide(network);
    return s == OK ? pst_stereo_guided(capture, params, &guide, out) : s;
}
