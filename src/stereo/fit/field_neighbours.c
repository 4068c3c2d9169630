/* SPDX-License-Identifier: MIT */
#include "stereo/fit/field_neighbours.h"

/* Largest strangeness of a majority's member, and how much stranger the pixel must be. Across a crease half of the
 * neighbours differ from each other, and none is wrong. docs/notes/real_captures.md states the effect. */
static const float most_strange = 0.4f, much_stranger = 0.2f;

/* 1 - cos 20 degrees */
static const float strange = 0.0603f;

static bool alike(const pst_shading *a, const pst_shading *b)
{
    static const float cosine = 0.9994f; /* cosine of 2 degrees */
    return vec3_dot(a->normal, b->normal) >= cosine;
}

/* Lists the indices in the field of the first `most` pixels around, adjacent ones first, and returns how many are in
 * it. */
static int list_around(const pst_around *a, size_t i, int most, int32_t place[8])
{
    static const int step[8][2] = {{-1, 0}, {1, 0}, {0, -1}, {0, 1}, {-1, -1}, {1, -1}, {-1, 1}, {1, 1}};
    const pst_field *f = a->field;
    int width = f->problem->capture->width, height = f->problem->capture->height, count = 0;
    int x = (int)(f->pixel[i] % (size_t)width), y = (int)(f->pixel[i] / (size_t)width);
    for (int k = 0; k < most; k++) {
        int nx = x + step[k][0], ny = y + step[k][1];
        if (nx < 0 || ny < 0 || nx >= width || ny >= height) continue;
        int32_t other = a->slot[(size_t)ny * (size_t)width + (size_t)nx];
        if (other >= 0) place[count++] = other;
    }
    return count;
}

int pst_better_neighbours(const pst_around *a, size_t i, const pst_shading *found[4])
{
    const pst_shading *own = &a->field->shading[i];
    int32_t place[8];
    int around = list_around(a, i, 4, place), count = 0;
    for (int k = 0; k < around; k++) {
        if (a->news && !a->news[place[k]]) continue;
        const pst_shading *from = &a->field->shading[place[k]];
        bool known = alike(from, own) || from->cost >= own->cost - PST_FAR_LESS;
        for (int m = 0; m < count; m++)
            known |= alike(from, found[m]);
        if (!known) found[count++] = from;
    }
    return count;
}

float pst_strangeness(const pst_majority *m, vec3 normal)
{
    float sum = 0;
    for (int k = 0; k < m->count; k++)
        sum += fminf((1 - vec3_dot(normal, m->normal[k])) / strange, 1);
    return sum / (float)m->count;
}

bool pst_majority_against(const pst_around *a, size_t i, pst_majority *m)
{
    int32_t place[8];
    m->count = list_around(a, i, 8, place);
    for (int k = 0; k < m->count; k++)
        m->normal[k] = a->field->shading[place[k]].normal;
    if (m->count < 3) return false;
    float own = pst_strangeness(m, a->field->shading[i].normal), least = own - much_stranger;
    if (!(least > 0)) return false;
    m->member = NULL;
    for (int k = 0; k < m->count; k++) {
        float one = pst_strangeness(m, m->normal[k]);
        if (one >= least || one > most_strange) continue;
        least = one;
        m->member = &a->field->shading[place[k]];
    }
    return m->member != NULL;
}
