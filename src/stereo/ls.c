/* Lambertian least squares (R. J. Woodham, Photometric method for determining surface orientation from multiple images,
 * Optical Engineering 19(1), 1980): per pixel the weighted 3×3 normal equations over observations that are neither dark
 * nor saturated, one right-hand side a colour channel.
 *
 * Pictures are streamed: a block of pixels small enough for the cache is summed over all pictures, so that every
 * sample is read from memory once and working memory does not grow with the number of pictures. */
#include <math.h>
#include <string.h>

#include "base/parallel.h"
#include "stereo/solve_parts.h"

/* 18 sums of 512 floats are 36 KiB: they stay in the second-level cache beside the pictures' own lines. */
enum { BLOCK = 512 };

/* Pixels looked at to choose what counts as dark. */
enum { SAMPLE = 1024 };

typedef struct sums {
    float matrix[6][BLOCK];
    float right[3][3][BLOCK]; /* channel, component */
    float square[BLOCK];
} sums;

typedef struct ls_job {
    const pst_problem *problem;
    pst_surface *out;
    float low; /* codes, summed over the channels */
    uint16_t high;
} ls_job;

/* What one picture's light contributes. */
typedef struct ls_light {
    float x, y, z;
    float scale[3]; /* code to radiance under unit intensity */
    float low;
    uint16_t high;
} ls_light;

static inline __attribute__((always_inline)) void add_weighted(sums *s, int i, float w, const ls_light *l)
{
    s->matrix[0][i] += w * (l->x * l->x);
    s->matrix[1][i] += w * (l->x * l->y);
    s->matrix[2][i] += w * (l->x * l->z);
    s->matrix[3][i] += w * (l->y * l->y);
    s->matrix[4][i] += w * (l->y * l->z);
    s->matrix[5][i] += w * (l->z * l->z);
}

static void add_grey(sums *restrict s, const uint16_t *restrict code, int count, const ls_light *l)
{
#pragma omp simd
    for (int i = 0; i < count; i++) {
        float w = (float)code[i] > l->low && code[i] < l->high ? 1.0f : 0.0f;
        float v = w * l->scale[0] * (float)code[i];
        add_weighted(s, i, w, l);
        s->right[0][0][i] += v * l->x;
        s->right[0][1][i] += v * l->y;
        s->right[0][2][i] += v * l->z;
        s->square[i] += v * v;
    }
}

static void add_colour(sums *restrict s, const uint16_t *restrict code, int count, const ls_light *l)
{
    float channel[3][BLOCK];
#pragma omp simd
    for (int i = 0; i < count; i++) {
        channel[0][i] = (float)code[3 * i];
        channel[1][i] = (float)code[3 * i + 1];
        channel[2][i] = (float)code[3 * i + 2];
    }
    float high = (float)l->high;
#pragma omp simd
    for (int i = 0; i < count; i++) {
        float r = channel[0][i], g = channel[1][i], b = channel[2][i];
        float top = r > g ? r : g;
        top = top > b ? top : b;
        float w = r + g + b > l->low && top < high ? 1.0f : 0.0f;
        add_weighted(s, i, w, l);
        r *= w * l->scale[0];
        g *= w * l->scale[1];
        b *= w * l->scale[2];
        s->right[0][0][i] += r * l->x;
        s->right[0][1][i] += r * l->y;
        s->right[0][2][i] += r * l->z;
        s->right[1][0][i] += g * l->x;
        s->right[1][1][i] += g * l->y;
        s->right[1][2][i] += g * l->z;
        s->right[2][0][i] += b * l->x;
        s->right[2][1][i] += b * l->y;
        s->right[2][2][i] += b * l->z;
        s->square[i] += r * r + g * g + b * b;
    }
}

/* What a block's sums say, a component after the other, so that pixels go through vector registers together. */
typedef struct answers {
    float normal[3][BLOCK], albedo[3][BLOCK], residual[BLOCK];
} answers;

/* fmaxf and fminf promise something about NaN, which costs a call. */
static inline float larger(float a, float b)
{
    return a > b ? a : b;
}

static inline float smaller(float a, float b)
{
    return a < b ? a : b;
}

/* pst_facing without a branch. */
static inline vec3 facing(vec3 n)
{
    float scale = 1 / sqrtf(smaller(larger(vec3_dot(n, n), 1e-37f), 1e37f));
    n = vec3_make(scale * n.x, scale * n.y, larger(scale * n.z, 1e-3f));
    return vec3_scale(n, 1 / sqrtf(vec3_dot(n, n)));
}

typedef struct symmetric {
    float xx, xy, xz, yy, yz, zz;
} symmetric;

static inline vec3 times(symmetric m, vec3 v)
{
    return vec3_make(m.xx * v.x + m.xy * v.y + m.xz * v.z, m.xy * v.x + m.yy * v.y + m.yz * v.z,
                     m.xz * v.x + m.yz * v.y + m.zz * v.z);
}

/* Damped as in pst_solve3. */
static inline symmetric inverse(symmetric m)
{
    float damping = 1e-6f * (m.xx + m.yy + m.zz) + 1e-30f;
    float xx = m.xx + damping, yy = m.yy + damping, zz = m.zz + damping;
    float c0 = yy * zz - m.yz * m.yz, c1 = m.xz * m.yz - m.xy * zz, c2 = m.xy * m.yz - m.xz * yy;
    float d = 1 / larger(xx * c0 + m.xy * c1 + m.xz * c2, 1e-37f);
    return (symmetric){c0 * d,
                       c1 * d,
                       c2 * d,
                       (xx * zz - m.xz * m.xz) * d,
                       (m.xy * m.xz - xx * m.yz) * d,
                       (xx * yy - m.xy * m.xy) * d};
}

static inline vec3 right_side(const sums *s, int channel, int i)
{
    return vec3_make(s->right[channel][0][i], s->right[channel][1][i], s->right[channel][2][i]);
}

/* The channels share the normal, not the albedo: each weighs by its own albedo, which is one step of the power
 * iteration for the best rank-one fit to all channels. Channels that a grey picture lacks are zero and change nothing.
 */
static void answer(const sums *restrict s, int count, answers *restrict out)
{
#pragma omp simd
    for (int i = 0; i < count; i++) {
        symmetric m = {s->matrix[0][i], s->matrix[1][i], s->matrix[2][i],
                       s->matrix[3][i], s->matrix[4][i], s->matrix[5][i]};
        symmetric solve = inverse(m);
        vec3 r = right_side(s, 0, i), g = right_side(s, 1, i), b = right_side(s, 2, i);
        vec3 n = facing(times(solve, vec3_add(vec3_add(r, g), b)));
        vec3 weighted = vec3_scale(r, larger(vec3_dot(r, n), 0));
        weighted = vec3_fma(weighted, larger(vec3_dot(g, n), 0), g);
        weighted = vec3_fma(weighted, larger(vec3_dot(b, n), 0), b);
        n = facing(times(solve, weighted));
        float share = 1 / larger(vec3_dot(n, times(m, n)), 1e-12f);
        float red = larger(vec3_dot(r, n), 0), green = larger(vec3_dot(g, n), 0), blue = larger(vec3_dot(b, n), 0);
        float explained = share * (red * red + green * green + blue * blue);
        out->normal[0][i] = n.x;
        out->normal[1][i] = n.y;
        out->normal[2][i] = n.z;
        out->albedo[0][i] = red * share;
        out->albedo[1][i] = green * share;
        out->albedo[2][i] = blue * share;
        float fits = explained > 0 ? 1.0f : 0.0f;
        out->residual[i] = fits * sqrtf(larger(s->square[i] - explained, 0) / larger(explained, 1e-37f));
    }
}

static void store(const answers *a, int count, const float *mask, const pst_surface *out, size_t first)
{
    size_t channels = (size_t)out->albedo.channels;
    float *normal = out->normal.data + 3 * first, *albedo = out->albedo.data + channels * first;
    for (int i = 0; i < count; i++) {
        if (mask[i] <= 0.5f) continue;
        for (size_t k = 0; k < 3; k++)
            normal[3 * (size_t)i + k] = a->normal[k][i];
        for (size_t c = 0; c < channels; c++)
            albedo[channels * (size_t)i + c] = a->albedo[c][i];
        out->residual.data[first + (size_t)i] = a->residual[i];
    }
}

static void solve_block(const ls_job *job, size_t first, int count)
{
    const pst_problem *p = job->problem;
    const pst_capture *c = p->capture;
    const float *mask = c->mask.data + first;
    bool any = false;
    for (int i = 0; i < count; i++)
        any |= mask[i] > 0.5f;
    if (!any) return;
    sums s;
    memset(&s, 0, sizeof s);
    for (int k = 0; k < c->count; k++) {
        const pst_light *from = &p->light[k];
        ls_light l = {.x = from->direction.x, .y = from->direction.y, .z = from->direction.z};
        for (int e = 0; e < 3; e++)
            l.scale[e] = 1 / (65535 * from->intensity[e]);
        l.low = job->low;
        l.high = job->high;
        const uint16_t *code = c->picture[k] + first * (size_t)c->channels;
        if (c->channels == 1)
            add_grey(&s, code, count, &l);
        else
            add_colour(&s, code, count, &l);
    }
    answers a;
    answer(&s, count, &a);
    store(&a, count, mask, job->out, first);
}

static void solve_blocks(void *context, size_t begin, size_t end)
{
    const ls_job *job = context;
    size_t size = (size_t)job->problem->capture->width * (size_t)job->problem->capture->height;
    for (size_t b = begin; b < end; b++) {
        size_t first = b * BLOCK, left = size - first;
        solve_block(job, first, (int)(left < BLOCK ? left : BLOCK));
    }
}

/* A hundredth of what the object's pixels reach at their brightest, on average. */
static float chosen_shadow(const pst_problem *p)
{
    const pst_capture *c = p->capture;
    size_t step = p->pixel_count / SAMPLE + 1, count = 0;
    double sum = 0;
    for (size_t i = 0; i < p->pixel_count; i += step, count++) {
        uint16_t top = 0;
        for (int k = 0; k < c->count; k++) {
            uint16_t code = c->picture[k][(size_t)p->pixel[i] * (size_t)c->channels];
            top = code > top ? code : top;
        }
        sum += top;
    }
    return (float)(0.01 * sum / (65535.0 * (double)count));
}

status pst_solve_ls(const pst_problem *p, pst_surface *out)
{
    const pst_capture *c = p->capture;
    ls_job job = {.problem = p,
                  .out = out,
                  .low = (p->shadow > 0 ? p->shadow : chosen_shadow(p)) * 65535 * (float)c->channels,
                  .high = (uint16_t)fminf(ceilf(p->saturation * 65535), 65535)};
    size_t size = (size_t)c->width * (size_t)c->height;
    parallel_blocks((size + BLOCK - 1) / BLOCK, solve_blocks, &job);
    return OK;
}
