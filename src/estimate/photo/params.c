/* SPDX-License-Identifier: MIT */
#include "estimate/photo/params.h"

#include <assert.h>
#include <math.h>

#include "estimate/photo/network.h"
#include "estimate/surface/exposure.h"
#include "optics/orientation.h"

static_assert((int)MERLIN_LEAST_SIZE == (int)NETWORK_LEAST_SIZE &&
                  (int)MERLIN_LARGEST_SIZE == (int)NETWORK_LARGEST_SIZE &&
                  (int)MERLIN_SIZE_STEP == (int)MODEL_SIZE_MULTIPLE,
              "the public sizes are the network's");

merlin_params merlin_params_default(void)
{
    return (merlin_params){.size = NETWORK_LARGEST_SIZE, .views = NETWORK_VIEWS, .auto_exposure = 1};
}

status params_check(const merlin_params *p)
{
    if (p->size < NETWORK_LEAST_SIZE || p->size > NETWORK_LARGEST_SIZE || p->size % MODEL_SIZE_MULTIPLE != 0)
        return fail(MERLIN_WRONG_USE, "the network's size must be a multiple of %d from %d to %d, not %d",
                    MODEL_SIZE_MULTIPLE, NETWORK_LEAST_SIZE, NETWORK_LARGEST_SIZE, p->size);
    if (p->views < 1 || p->views > ORIENTATIONS)
        return fail(MERLIN_WRONG_USE, "a photograph has 1 to %d views, not %d", ORIENTATIONS, p->views);
    if (p->fov != 0 && !(p->fov >= 1 && p->fov <= 150))
        return fail(MERLIN_WRONG_USE, "a field of view must be from 1 to 150 degrees, not %g", (double)p->fov);
    if (p->auto_exposure || fabsf(p->exposure) <= EXPOSURE_MOST_EV) return OK;
    return fail(MERLIN_WRONG_USE, "an exposure must be within %g EV, not %g", (double)EXPOSURE_MOST_EV,
                (double)p->exposure);
}
