/* SPDX-License-Identifier: MIT */
#include "stereo/fit/problem.h"

#include <stdlib.h>

#include "stereo/algebra/dense.h"

/* Least ratio of a light list's smallest singular value to its largest: in a flatter one noise determines the normal's
 * component out of its plane. */
static const float flattest_lights = 0.01f;

static void add_square(vec3 v, const double about[3], double m[9])
{
    double d[3] = {v.x - about[0], v.y - about[1], v.z - about[2]};
    for (int j = 0; j < 9; j++)
        m[j] += d[j / 3] * d[j % 3];
}

status pst_check_directions(const merlin_light *light, int count)
{
    if (count < 3)
        return fail(MERLIN_BAD_INPUT, "photometric stereo needs pictures under 3 or more lights, not %d", count);
    double m[9] = {0}, eigenvalue[6];
    for (int i = 0; i < count; i++)
        add_square(vec3_of(light[i].direction), (const double[3]){0}, m);
    if (!dense_eigen(m, 3, false, eigenvalue)) return fail(MERLIN_BAD_INPUT, "the light directions are not numbers");
    if (!(eigenvalue[0] > flattest_lights * flattest_lights * eigenvalue[2]))
        return fail(MERLIN_BAD_INPUT, "the %d light directions lie in one plane; light the object from a third side",
                    count);
    return OK;
}

/* Fails for lights on one line: from any point their directions are in one plane. */
status pst_check_positions(const merlin_light *light, int count)
{
    double m[9] = {0}, eigenvalue[6], mean[3] = {0};
    for (int i = 0; i < count; i++) {
        mean[0] += (double)light[i].position[0] / count;
        mean[1] += (double)light[i].position[1] / count;
        mean[2] += (double)light[i].position[2] / count;
    }
    for (int i = 0; i < count; i++)
        add_square(vec3_of(light[i].position), mean, m);
    if (!dense_eigen(m, 3, false, eigenvalue)) return fail(MERLIN_BAD_INPUT, "the light positions are not numbers");
    if (!(eigenvalue[1] > flattest_lights * flattest_lights * eigenvalue[2]))
        return fail(MERLIN_BAD_INPUT, "the %d light positions lie on one line; light the object from a third side",
                    count);
    return OK;
}

status pst_list_pixels(const merlin_capture *c, pst_problem *p)
{
    size_t size = (size_t)c->width * (size_t)c->height, n = 0;
    p->pixel = malloc(size * sizeof *p->pixel);
    if (!p->pixel) return fail(MERLIN_NO_MEMORY, "no memory for a list of %zu pixels", size);
    for (size_t i = 0; i < size; i++)
        if (c->mask.data[i] > 0.5f) p->pixel[n++] = (uint32_t)i;
    p->pixel_count = n;
    return OK;
}

pst_bounds pst_bounds_of(const pst_problem *p)
{
    const size_t width = (size_t)p->capture->width;
    pst_bounds r = {.left = p->capture->width,
                    .right = 0,
                    .top = (int)(p->pixel[0] / width),
                    .bottom = (int)(p->pixel[p->pixel_count - 1] / width)};
    for (size_t i = 0; i < p->pixel_count; i++) {
        int x = (int)(p->pixel[i] % width);
        r.left = x < r.left ? x : r.left;
        r.right = x > r.right ? x : r.right;
    }
    return r;
}

void pst_effort_add(pst_effort *e, size_t fits)
{
    size_t done = atomic_fetch_add_explicit(&e->done, fits, memory_order_relaxed) + fits;
    if (!pthread_equal(e->owner, pthread_self())) return;
    double share = (double)done / (double)e->expected;
    watch_tell(e->watch, "solving", share < 1 ? share : 1);
}
