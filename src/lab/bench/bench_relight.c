/* SPDX-License-Identifier: MIT */
#include "lab/bench/bench_relight.h"

#include "base/api_needs.h"
#include "lab/bench/bench_ball.h"
#include "merlin/merlin.h"

enum { SIDE = 256 };

typedef struct relight_bench {
    merlin_model *model;
    merlin_maps maps;
    merlin_relighting how;
    merlin_relighter *relighter;
} relight_bench;

static status make_relighter(void *context)
{
    relight_bench *w = context;
    merlin_relighter_free(w->relighter);
    return merlin_relighter_new(w->model, &w->maps, SIDE, w->how, &w->relighter);
}

static status render(void *context)
{
    relight_bench *w = context;
    static const float from_the_left[3] = {-0.67f, 0.47f, -0.43f};
    merlin_image picture;
    status s = merlin_relighter_render(w->relighter, from_the_left, NULL, &picture);
    merlin_image_free(&picture);
    return s;
}

static status estimate_ball(relight_bench *w)
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
    relight_bench w = {0};
    status s = merlin_model_open(weights, &w.model);
    if (s == OK) s = estimate_ball(&w);
    for (int i = 0; i < BENCH_WAYS && s == OK; i++) {
        w.how = (merlin_relighting)i;
        s = bench_time(make_relighter, &w, patience, &out->ready_seconds[i]);
        if (s == OK) s = bench_time(render, &w, patience, &out->light_seconds[i]);
    }
    merlin_relighter_free(w.relighter);
    merlin_maps_free(&w.maps);
    merlin_model_close(w.model);
    return s;
}
