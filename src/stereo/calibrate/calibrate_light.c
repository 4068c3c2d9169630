/* SPDX-License-Identifier: MIT */
/* Finds one light from one picture of a ball: the mirror direction of a chrome ball's highlight, or the least-squares
 * light of a matte ball's shading. */
#include <stdlib.h>
#include <string.h>

#include "stereo/calibrate/calibrate_parts.h"

static const float INSIDE =
    0.97f; /* share of the radius: the rim mirrors what is behind the ball and mixes with the background */

/* ---- chrome ---- */

typedef struct blob {
    double sum, x, y; /* weight and weighted position */
    size_t area;
} blob;

/* Computes the normal of a pixel that is not too near the outline. */
static bool normal_inside(const ball_view *view, int x, int y, float share, vec3 *n)
{
    vec3 v;
    return ball_point(view, (float)x + 0.5f, (float)y + 0.5f, n, &v) && vec3_dot(*n, v) > sqrtf(1 - share * share);
}

static bool inside(const ball_view *view, int x, int y, float share)
{
    vec3 n;
    return normal_inside(view, x, y, share, &n);
}

static float brightest_inside(const img *p, const ball_view *view)
{
    float most = 0;
    for (int y = 0; y < p->height; y++)
        for (int x = 0; x < p->width; x++)
            if (inside(view, x, y, INSIDE)) most = fmaxf(most, *img_at(p, x, y));
    return most;
}

typedef struct flood {
    img left;   /* copy of the picture; visited pixels become 0 */
    int *stack; /* pixel indices */
    float level;
} flood;

static void visit(flood *f, int at, size_t *depth, blob *b)
{
    float value = f->left.data[at] - f->level;
    if (!(value > 0)) return;
    f->left.data[at] = 0;
    int column = at % f->left.width, row = at / f->left.width;
    b->sum += value;
    b->x += value * (column + 0.5);
    b->y += value * (row + 0.5);
    b->area++;
    f->stack[(*depth)++] = at;
}

/* Collects the connected patch above the level around a pixel. */
static blob grow(flood *f, int start)
{
    blob b = {0};
    size_t depth = 0;
    visit(f, start, &depth, &b);
    while (depth) {
        size_t next[4];
        int count = img_beside(f->left.width, f->left.height, (size_t)f->stack[--depth], next);
        for (int i = 0; i < count; i++)
            visit(f, (int)next[i], &depth, &b);
    }
    return b;
}

static float apart(const blob *a, const blob *b)
{
    return (float)hypot(a->x / a->sum - b->x / b->sum, a->y / a->sum - b->y / b->sum);
}

/* The patches of a ball above a level. */
typedef struct blobs {
    blob *at;
    size_t count;
} blobs;

static const blob *strongest(const blobs *all)
{
    const blob *most = all->at;
    for (size_t i = 1; i < all->count; i++)
        if (all->at[i].sum > most->sum) most = &all->at[i];
    return most;
}

/* Returns the strongest patch's share of the sum of itself and all distant ones: panes of one window count as one. */
static double share_of(const blob *b, const blobs *all, float away)
{
    double others = 0;
    for (size_t i = 0; i < all->count; i++)
        if (apart(b, &all->at[i]) > away) others += all->at[i].sum;
    return b->sum / (b->sum + others);
}

static status list_blobs(const ball_view *view, flood *f, blobs *out)
{
    int w = f->left.width, h = f->left.height;
    for (int y = 0; y < h; y++)
        for (int x = 0; x < w; x++) {
            int at = y * w + x;
            if (!(f->left.data[at] > f->level) || !inside(view, x, y, INSIDE)) continue;
            blob *larger = realloc(out->at, (out->count + 1) * sizeof *larger);
            if (!larger) return fail(MERLIN_NO_MEMORY, "no memory for highlights");
            out->at = larger;
            out->at[out->count++] = grow(f, at);
        }
    return OK;
}

static status find_blobs(const img *p, const ball_view *view, float level, blobs *out)
{
    *out = (blobs){0};
    flood f = {.level = level};
    status s = img_copy(&f.left, p);
    if (s != OK) return s;
    f.stack = malloc((size_t)p->width * (size_t)p->height * sizeof *f.stack);
    s = f.stack ? list_blobs(view, &f, out) : fail(MERLIN_NO_MEMORY, "no memory for a highlight");
    free(f.stack);
    img_free(&f.left);
    return s;
}

status ball_mirror_light(const img *picture, const ball_view *view, merlin_circle *highlight, vec3 *direction)
{
    static const float LEVEL = 0.5f;        /* share of the peak */
    static const float LEAST_PEAK = 0.004f; /* share of full scale: an 8-bit step */
    static const float PANES = 0.2f;        /* share of the radius: about 23 degrees between lights */
    /* noise, if the light failed or its reflection is outside the picture, has 0.01 to 0.02; a second lamp of equal
     * brightness 0.5 */
    static const double LEAST_SHARE = 0.55;
    float peak = brightest_inside(picture, view);
    if (!(peak > LEAST_PEAK)) return fail(MERLIN_BAD_INPUT, "no highlight on the ball");
    blob b = {0};
    blobs all;
    status s = find_blobs(picture, view, LEVEL * peak, &all);
    if (s == OK) b = *strongest(&all);
    double share = s == OK ? share_of(&b, &all, PANES * view->circle.radius) : 0;
    free(all.at);
    if (s != OK) return s;
    if (share < LEAST_SHARE)
        return fail(MERLIN_BAD_INPUT, "no highlight on the ball stands out: was the light on, and the only one?");
    *highlight = (merlin_circle){(float)(b.x / b.sum), (float)(b.y / b.sum), sqrtf((float)b.area / 3.14159265f)};
    if (highlight->radius > 0.5f * view->circle.radius)
        return fail(MERLIN_BAD_INPUT, "what is bright covers more than a quarter of the ball: is it chrome?");
    vec3 n, v;
    if (!ball_point(view, highlight->x, highlight->y, &n, &v))
        return fail(MERLIN_BAD_INPUT, "the highlight is not on the ball");
    *direction = vec3_normalize(vec3_sub(vec3_scale(n, 2 * vec3_dot(n, v)), v));
    return OK;
}

/* ---- matte ---- */

typedef struct shade {
    vec3 normal;
    float value;
    bool used;
} shade;

static size_t collect_shades(const img *p, const ball_view *view, shade *out)
{
    size_t count = 0;
    for (int y = 0; y < p->height; y++)
        for (int x = 0; x < p->width; x++) {
            vec3 n;
            if (!normal_inside(view, x, y, INSIDE, &n)) continue;
            out[count++] = (shade){n, *img_at(p, x, y), true};
        }
    return count;
}

/* Solves value = light · normal by least squares over the shades in use; returns false if they do not span space. */
static bool solve_light(const shade *at, size_t count, vec3 *light)
{
    double m[6] = {0}, v[3] = {0};
    for (size_t i = 0; i < count; i++) {
        if (!at[i].used) continue;
        double x = at[i].normal.x, y = at[i].normal.y, z = at[i].normal.z, value = at[i].value;
        m[0] += x * x, m[1] += x * y, m[2] += x * z, m[3] += y * y, m[4] += y * z, m[5] += z * z;
        v[0] += x * value, v[1] += y * value, v[2] += z * value;
    }
    double a = m[3] * m[5] - m[4] * m[4], b = m[2] * m[4] - m[1] * m[5], k = m[1] * m[4] - m[2] * m[3];
    double det = m[0] * a + m[1] * b + m[2] * k;
    if (!(det > 1e-12 * pow(m[0] + m[3] + m[5], 3))) return false;
    double p = m[0] * m[5] - m[2] * m[2], q = m[1] * m[2] - m[0] * m[4], r = m[0] * m[3] - m[1] * m[1];
    *light = vec3_make((real)((a * v[0] + b * v[1] + k * v[2]) / det), (real)((b * v[0] + p * v[1] + q * v[2]) / det),
                       (real)((k * v[0] + q * v[1] + r * v[2]) / det));
    return true;
}

/* Uses the shades that face the light and fit it; returns the root mean square of their residuals relative to the
 * light. */
static float select_lit(shade *at, size_t count, vec3 light, float spread)
{
    static const float GRAZING = 0.1f; /* cosine: below, roughness and penumbrae have more effect than the light */
    double sum = 0;
    size_t used = 0;
    float power = vec3_length(light);
    for (size_t i = 0; i < count; i++) {
        float expected = vec3_dot(light, at[i].normal), off = at[i].value - expected;
        at[i].used = expected > GRAZING * power && at[i].value < PST_SATURATED && fabsf(off) < 3 * spread * power;
        if (!at[i].used) continue;
        sum += (double)off * off;
        used++;
    }
    return used && power > 0 ? (float)sqrt(sum / (double)used) / power : 0;
}

static status fit_light(shade *at, size_t count, float *residual, vec3 *direction)
{
    enum { ROUNDS = 15, LEAST_USED = 50 };
    vec3 light = {0, 0, 0};
    float most = 0, spread = 1;
    for (size_t i = 0; i < count; i++)
        most = fmaxf(most, at[i].value);
    for (size_t i = 0; i < count; i++)
        at[i].used = at[i].value > 0.1f * most;
    for (int round = 0; round < ROUNDS; round++) {
        if (!solve_light(at, count, &light) || !(vec3_length(light) > 1e-4f))
            return fail(MERLIN_BAD_INPUT, "the ball is not lit enough to tell where from");
        spread = select_lit(at, count, light, fmaxf(spread, 0.01f));
    }
    size_t used = 0;
    for (size_t i = 0; i < count; i++)
        used += at[i].used;
    if (used < LEAST_USED) return fail(MERLIN_BAD_INPUT, "only %zu pixels of the ball are lit as by one light", used);
    *residual = spread;
    *direction = vec3_normalize(light);
    return OK;
}

status ball_shading_light(const img *picture, const ball_view *view, float *residual, vec3 *direction)
{
    shade *at = malloc((size_t)picture->width * (size_t)picture->height * sizeof *at);
    if (!at) return fail(MERLIN_NO_MEMORY, "no memory for a ball's shading");
    size_t count = collect_shades(picture, view, at);
    status s = fit_light(at, count, residual, direction);
    free(at);
    return s;
}

bool ball_dark_level(const img *picture, const ball_view *view, vec3 light, float *level)
{
    enum { LEAST_SEEN = 50 };
    static const float AWAY = -0.15f; /* cosine: outside any lamp's penumbra */
    double sum = 0;
    size_t seen = 0;
    for (int y = 0; y < picture->height; y++)
        for (int x = 0; x < picture->width; x++) {
            vec3 n;
            if (!normal_inside(view, x, y, INSIDE, &n) || vec3_dot(n, light) > AWAY) continue;
            sum += (double)*img_at(picture, x, y);
            seen++;
        }
    if (seen < LEAST_SEEN) return false;
    *level = (float)(sum / (double)seen);
    return true;
}
