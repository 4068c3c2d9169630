/* SPDX-License-Identifier: MIT */
#include "photo_stereo/relit.h"

#include "base/rng.h"
#include "estimate/photo/model_pair.h"
#include "estimate/relight/relighter.h"
#include "optics/camera.h"
#include "optics/light.h"
#include "photo_stereo/near_capture.h"

enum { SEED = 1, STREAM_LIGHT = 1 };

static vec3 light_at(int i)
{
    rng r = rng_at(SEED, (uint64_t)i, STREAM_LIGHT);
    float u1 = rng_uniform(&r), u2 = rng_uniform(&r);
    return frontal_light(u1, u2);
}

static status relight_all(network *n, const relighter *st, int (*stop)(void), merlin_capture *c)
{
    status s = near_capture_new(&st->full.mask, &st->full.depth, CAMERA_FOV, c);
    for (int i = 0; i < RELIT_LIGHTS && s == OK; i++) {
        if (stop && stop()) return fail(MERLIN_STOPPED, "stopped");
        img picture = {0};
        const lamp light = lamp_at(light_at(i));
        s = relighter_render(n, st, &light, 1, &picture);
        if (s == OK)
            s = near_capture_add(c, &picture, &(merlin_light){.position = {light.at.x, light.at.y, light.at.z}});
        img_free(&picture);
    }
    return s;
}

status relit_new(merlin_model *model, const merlin_maps *maps, int side, merlin_relighting how, int (*stop)(void),
                 relit *out)
{
    *out = (relit){0};
    relighter st;
    network *n = model_network(model, maps, how);
    status s = relighter_new(n, maps, side, how, &st);
    if (s != OK) return s;
    st.white = NEAR_CAPTURE_WHITE;
    s = relight_all(n, &st, stop, &out->capture);
    out->maps = st.full;
    st.full = (surface){0};
    relighter_free(&st);
    if (s != OK) relit_free(out);
    return s;
}

void relit_free(relit *r)
{
    pst_capture_free(&r->capture);
    surface_free(&r->maps);
}
