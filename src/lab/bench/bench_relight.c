/* SPDX-License-Identifier: MIT */
#include "lab/bench/bench_relight.h"

#include "base/api_needs.h"
#include "lab/bench/bench_ball.h"
#include "merlin/merlin.h"

enum { SIDE = 256 };

typedef struct relight_work {
    merlin_model *model;
    merlin_maps maps;
    merlin_relighting how;
    merlin_stage *stage;
} relight_work;

static status make_stage(void *context)
{
    relight_work *w = context;
    merlin_stage_free(w->stage);
    return merlin_stage_new(w->model, &w->maps, SIDE, w->how, &w->stage);
}

static status light_stage(void *context)
{
    relight_work *w = context;
    static const float from_the_left[3] = {-0.67f, 0.47f, -0.43f};
    merlin_image picture;
    status s = merlin_stage_relight(w->stage, from_the_left, NULL, &picture);
    merlin_image_free(&picture);
    return s;
}

static status estimate_ball(relight_work *w)
{
    img ball;
    status s = bench_ball(&ball);
    if (s != OK) return s;
    merlin_image photo = ball;
    s = merlin_estimate(w->model, &photo, NULL, NULL, &w->maps);
    img_free(&ball);
    return s;
}

status bench_relight(const char *weights, bench_budget patience, bench_relighting *out)
{
    relight_work w = {0};
    status s = merlin_model_open(weights, &w.model);
    if (s == OK) s = estimate_ball(&w);
    for (int i = 0; i < BENCH_WAYS && s == OK; i++) {
        w.how = (merlin_relighting)i;
        s = bench_time(make_stage, &w, patience, &out->stage_seconds[i]);
        if (s == OK) s = bench_time(light_stage, &w, patience, &out->light_seconds[i]);
    }
    merlin_stage_free(w.stage);
    merlin_maps_free(&w.maps);
    merlin_model_close(w.model);
    return s;
}
