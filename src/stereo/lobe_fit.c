/* Gauss-Newton with Levenberg's damping under the redescending loss of Geman & McClure (1987), its scale narrowed step
 * by step as in pixel_fit.c. The unknowns are two angles of the normal, the albedo, the lobe's height and the logarithm
 * of its sharpness. A residual counts relative to the pixel's ordinary brightness or, for what is brighter, to the
 * value itself: a lobe's model is right to a share of its height, and a highlight's flank fixes the normal all the
 * same. */
#include "stereo/lobe_fit.h"

#include <math.h>

#include "stereo/solve_parts.h"

enum { UNKNOWNS = 5, PRODUCTS = UNKNOWNS * (UNKNOWNS + 1) / 2 };

/* What an observation that is far below the fit is charged. */
static inline float charge(float shadowy, float value, float residual)
{
    return PST_IS_SHADOW(value, residual) ? 1 - shadowy : 1;
}

/* Where a lobe's own width is wider, the narrowing ends there. */
static const float widths[] = {0.16f, 0.16f, 0.16f, 0.11f, 0.08f, 0.057f, 0.04f, 0.04f, 0.04f, 0.04f, 0.04f, 0.04f};
/* Parts that the observations are held out in. */
enum { PARTS = 4 };
enum { STEPS = sizeof widths / sizeof *widths, NEAR = 4 }; /* NEAR: where a good start begins */

/* u from lobes wider than the hemisphere to mirrors */
static const float least_sharpness = -2.3f, most_sharpness = 11;
static const float trial_sharpness[] = {0.7f, 2.2f, 3.7f, 5.2f, 6.7f, 8.5f};
enum { TRIALS = sizeof trial_sharpness / sizeof *trial_sharpness };

/* Values below a hundredth of the brightest are the dark ones. */
static const float dark = 0.01f;

/* The median of what is not dark, to 4 percent: the interval is halved in logarithms. */
float pst_ordinary_level(const pst_observations *o)
{
    const float *value = o->value, *usable = o->usable;
    const int n = pst_whole(o->padded);
    float top = 0, all = 0;
#pragma omp simd reduction(max : top)
    for (int i = 0; i < n; i++) {
        float v = usable[i] * value[i];
        top = v > top ? v : top;
    }
    float least = dark * top, low = least, high = top;
#pragma omp simd reduction(+ : all)
    for (int i = 0; i < n; i++)
        all += value[i] > least ? usable[i] : 0;
    for (int round = 0; round < 7; round++) {
        float middle = sqrtf(low * high), below = 0;
#pragma omp simd reduction(+ : below)
        for (int i = 0; i < n; i++)
            below += value[i] > least && value[i] < middle ? usable[i] : 0;
        if (below > 0.5f * all)
            high = middle;
        else
            low = middle;
    }
    return sqrtf(low * high);
}

void pst_lobe_prepare(const pst_observations *o, vec3 view, float shadow, pst_lobe_data *out)
{
    const float *lx = o->x, *ly = o->y, *lz = o->z, *value = o->value, *usable = o->usable;
    const int n = pst_whole(o->padded);
    out->seen = *o;
    out->level = pst_ordinary_level(o);
    float level = out->level > 1e-12f ? out->level : 1e-12f, less = 1 - shadow;
#pragma omp simd
    for (int i = 0; i < n; i++) {
        float x = lx[i] + view.x, y = ly[i] + view.y, z = lz[i] + view.z, v = value[i];
        float inverse = 1 / sqrtf(x * x + y * y + z * z + 1e-12f), above = v > level ? v - level : 0;
        out->hx[i] = x * inverse;
        out->hy[i] = y * inverse;
        out->hz[i] = z * inverse;
        out->shadowy[i] = v < 0.5f * level ? less : 0;
        out->precision[i] = usable[i] / (level * level + above * above);
    }
}

/* The distribution by its argument x = sin² of the angle between n and h, without a branch: one of the three
 * powers counts (none for Lambert's law), and c = 1 − bend x turns the sine into the tangent. */
typedef struct tail_choice {
    float two, four, eight, bend;
} tail_choice;

static inline tail_choice choose_tail(int tail)
{
    return (tail_choice){tail == 2 ? 1 : 0, tail == 4 ? 1 : 0, tail == 8 ? 1 : 0, tail == 8 ? 0.999f : 0};
}

/* base^(γ − 1) */
static inline float power_below(const tail_choice *t, float base)
{
    float two = base * base;
    return base * (t->two + two * (t->four + t->eight * (two * two)));
}

/* The lobe at x and at the cosine to the light, of height 1; one division for distribution and masking. */
static inline float lobe_at(const tail_choice *t, float u, float x, float lit, float k)
{
    float c = 1 - t->bend * x, wide = c + u * x, mask = lit * (1 - k) + k + 1e-6f, both = 1 / (wide * mask);
    float base = c * both * mask;
    return base * power_below(t, base) * lit * both * wide;
}

static float loss(const pst_lobe_data *d, const pst_lobe *lobe, const pst_shading *at, float width)
{
    const float *lx = d->seen.x, *ly = d->seen.y, *lz = d->seen.z, *value = d->seen.value, *usable = d->seen.usable;
    const int count = pst_whole(d->seen.padded);
    const tail_choice tail = choose_tail(lobe->tail);
    const vec3 n = at->normal;
    float u = expf(at->sharpness), tau = lobe->terminator, k = lobe->masking, cost = 0;
    float narrow = 1 / (width * width), a = at->albedo, s = at->gloss;
#pragma omp simd reduction(+ : cost)
    for (int i = 0; i < count; i++) {
        float nl = n.x * lx[i] + n.y * ly[i] + n.z * lz[i], v = value[i];
        float nh = n.x * d->hx[i] + n.y * d->hy[i] + n.z * d->hz[i];
        float x = 1 - nh * nh, diffuse = nl > tau ? nl - tau : 0, lit = nl > 0 ? nl : 0;
        float lobe_value = lobe_at(&tail, u, x > 0 ? x : 0, lit, k);
        float r = v - a * diffuse - s * lobe_value;
        float t = r * r * d->precision[i] * narrow;
        cost += usable[i] * charge(d->shadowy[i], v, r) * t / (1 + t);
    }
    return cost;
}

/* Normal equations of the weighted, linearized problem; upper triangle by rows. */
typedef struct equations {
    float m[PRODUCTS], right[UNKNOWNS];
    float loss, loss_before; /* at the width of the weights; at the width before */
    vec3 t1, t2;             /* the directions that the first two unknowns turn the normal to */
} equations;

static void linearize(const pst_lobe_data *d, const pst_lobe *lobe, const pst_shading *at, float width,
                      float width_before, equations *e)
{
    vec3 t1, t2;
    pst_tangents(at->normal, &t1, &t2);
    const float *px = d->seen.x, *py = d->seen.y, *pz = d->seen.z, *value = d->seen.value, *usable = d->seen.usable;
    const int count = pst_whole(d->seen.padded);
    const tail_choice tail = choose_tail(lobe->tail);
    const vec3 n = at->normal;
    const float u = expf(at->sharpness), tau = lobe->terminator, k = lobe->masking, narrow = 1 / (width * width);
    const float a = at->albedo, s = at->gloss, gamma = (float)lobe->tail,
                shrunk = width * width / (width_before * width_before);
    float m00 = 0, m01 = 0, m02 = 0, m03 = 0, m04 = 0, m11 = 0, m12 = 0, m13 = 0, m14 = 0, m22 = 0, m23 = 0, m24 = 0;
    float m33 = 0, m34 = 0, m44 = 0, r0 = 0, r1 = 0, r2 = 0, r3 = 0, r4 = 0, cost = 0, before = 0;
#pragma omp simd reduction(+ : m00, m01, m02, m03, m04, m11, m12, m13, m14, m22, m23, m24, m33, m34, m44, r0, r1, r2, \
                               r3, r4, cost, before)
    for (int i = 0; i < count; i++) {
        float lx = px[i], ly = py[i], lz = pz[i], hx = d->hx[i], hy = d->hy[i], hz = d->hz[i], v = value[i];
        float nl = n.x * lx + n.y * ly + n.z * lz, nh = n.x * hx + n.y * hy + n.z * hz;
        float x = 1 - nh * nh, lit = nl > 0 ? nl : 0, diffuse = nl > tau ? nl - tau : 0;
        x = x > 0 ? x : 0;
        float bent = 1 - tail.bend * x, wide = bent + u * x, mask = lit * (1 - k) + k + 1e-6f;
        float both = 1 / (wide * mask), inverse = both * mask, below = both * wide; /* one division for two */
        float base = bent * inverse, pm = power_below(&tail, base);
        float g = lit * below, by_g = (nl > 0 ? k : 0) * below * below, p = pm * base, gp = g * p;
        float r = v - a * diffuse - s * gp, c = d->precision[i] * narrow, t = r * r * c, q = 1 / (1 + t);
        float counts = charge(d->shadowy[i], v, r), w = c * q * q * counts, by_nl = (nl > tau ? a : 0) + s * by_g * p,
              by_nh = 2 * gamma * u * s * g * pm * inverse * inverse * nh;
        float j0 = by_nl * (lx * t1.x + ly * t1.y + lz * t1.z) + by_nh * (hx * t1.x + hy * t1.y + hz * t1.z);
        float j1 = by_nl * (lx * t2.x + ly * t2.y + lz * t2.z) + by_nh * (hx * t2.x + hy * t2.y + hz * t2.z);
        float j2 = diffuse, j3 = gp, j4 = -gamma * u * x * inverse * s * gp;
        float w0 = w * j0, w1 = w * j1, w2 = w * j2, w3 = w * j3, w4 = w * j4;
        cost += usable[i] * counts * t * q;
        before += usable[i] * counts * (t * shrunk) / (1 + t * shrunk);
        m00 += w0 * j0;
        m01 += w0 * j1;
        m02 += w0 * j2;
        m03 += w0 * j3;
        m04 += w0 * j4;
        m11 += w1 * j1;
        m12 += w1 * j2;
        m13 += w1 * j3;
        m14 += w1 * j4;
        m22 += w2 * j2;
        m23 += w2 * j3;
        m24 += w2 * j4;
        m33 += w3 * j3;
        m34 += w3 * j4;
        m44 += w4 * j4;
        r0 += w0 * r;
        r1 += w1 * r;
        r2 += w2 * r;
        r3 += w3 * r;
        r4 += w4 * r;
    }
    *e = (equations){{m00, m01, m02, m03, m04, m11, m12, m13, m14, m22, m23, m24, m33, m34, m44},
                     {r0, r1, r2, r3, r4},
                     cost,
                     before,
                     t1,
                     t2};
}

/* (M + damping diag M) x = right by factors L D Lᵀ; a direction that nothing fixes stays 0. */
static void solve5(const equations *e, float damping, float x[UNKNOWNS])
{
    static const int row[UNKNOWNS] = {0, 4, 7, 9, 10}; /* m[row[i] + j] is entry (i, j), j >= i */
    float l[UNKNOWNS][UNKNOWNS] = {{0}}, inverse[UNKNOWNS] = {0};
#pragma GCC unroll 5
    for (int i = 0; i < UNKNOWNS; i++) {
        float diagonal = e->m[row[i] + i], sum = diagonal * (1 + damping), right = e->right[i];
#pragma GCC unroll 5
        for (int k = 0; k < i; k++) {
            sum -= l[i][k] * l[i][k] * inverse[k];
            right -= l[i][k] * inverse[k] * x[k];
        }
        inverse[i] = sum > 1e-5f * diagonal && diagonal > 1e-20f ? 1 / sum : 0;
        x[i] = right;
#pragma GCC unroll 5
        for (int j = i + 1; j < UNKNOWNS; j++) {
            float v = e->m[row[i] + j];
#pragma GCC unroll 5
            for (int k = 0; k < i; k++)
                v -= l[i][k] * inverse[k] * l[j][k];
            l[j][i] = v;
        }
    }
#pragma GCC unroll 5
    for (int i = UNKNOWNS - 1; i >= 0; i--) {
        float v = x[i];
#pragma GCC unroll 5
        for (int k = i + 1; k < UNKNOWNS; k++)
            v -= l[k][i] * x[k];
        x[i] = v * inverse[i];
    }
}

static float clamp(float x, float low, float high)
{
    return x < low ? low : x > high ? high : x;
}

static pst_shading moved(const pst_shading *at, const equations *e, float damping)
{
    float x[UNKNOWNS] = {0};
    solve5(e, damping, x);
    pst_shading next = *at;
    float turn = sqrtf(x[0] * x[0] + x[1] * x[1]), most = turn > 0.4f ? 0.4f / turn : 1;
    next.normal = vec3_normalize(vec3_fma(vec3_fma(at->normal, most * x[0], e->t1), most * x[1], e->t2));
    next.albedo = fmaxf(at->albedo + x[2], 0);
    next.gloss = fmaxf(at->gloss + x[3], 0);
    next.sharpness = clamp(at->sharpness + clamp(x[4], -1, 1), least_sharpness, most_sharpness);
    return next;
}

/* Nothing to gain from another step of the same width. */
static bool settled(const pst_shading *before, const pst_shading *after, float loss, float loss_after)
{
    vec3 turn = vec3_sub(after->normal, before->normal);
    return vec3_dot(turn, turn) < 1.6e-7f && loss_after > 0.99f * loss - 1e-3f;
}

/* Damped steps of ever smaller width; the damping grows where a step does not help. A step is judged at its own width
 * by what is needed for the next one anyway. */
static pst_shading narrow_down(const pst_lobe_data *d, const pst_lobe *lobe, pst_shading at, int from, float damping)
{
    float width = fmaxf(widths[from], lobe->width);
    int failures = 0;
    equations e, f;
    linearize(d, lobe, &at, width, width, &e);
    for (int k = from; k < STEPS; k++) {
        float narrower = k + 1 < STEPS ? fmaxf(widths[k + 1], lobe->width) : width;
        bool last = narrower == width;
        pst_shading next = moved(&at, &e, damping);
        linearize(d, lobe, &next, narrower, width, &f);
        if (f.loss_before < e.loss) {
            bool done = last && settled(&at, &next, e.loss, f.loss_before);
            damping *= 0.3f;
            failures = 0;
            at = next;
            e = f;
            if (done) break;
        } else {
            damping = damping * 10 + 1e-3f;
            if (last && ++failures == 2) break;
            if (!last) linearize(d, lobe, &at, narrower, narrower, &e);
        }
        width = narrower;
    }
    at.cost = e.loss;
    return at;
}

/* (1 + u x)^−γ falls by γ u at the lobe's top. */
pst_shading pst_lobe_translate(const pst_lobe *from, const pst_lobe *to, const pst_shading *at)
{
    pst_shading start = *at;
    if (from->tail > 0 && to->tail > 0)
        start.sharpness =
            clamp(at->sharpness + logf((float)from->tail / (float)to->tail), least_sharpness, most_sharpness);
    return start;
}

pst_shading pst_lobe_refine(const pst_lobe_data *d, const pst_lobe *lobe, const pst_shading *start)
{
    return narrow_down(d, lobe, *start, NEAR, 1e-3f);
}

/* Albedo and gloss for a given normal and sharpness, by weights of the heights before; both stay above 0. */
static void fit_heights(const pst_lobe_data *d, const pst_lobe *lobe, float width, pst_shading *at)
{
    const float *lx = d->seen.x, *ly = d->seen.y, *lz = d->seen.z, *value = d->seen.value;
    const int count = pst_whole(d->seen.padded);
    const tail_choice tail = choose_tail(lobe->tail);
    const vec3 n = at->normal;
    const float u = expf(at->sharpness), tau = lobe->terminator, k = lobe->masking, narrow = 1 / (width * width);
    float a = at->albedo, s = at->gloss, aa = 1e-20f, as = 0, ss = 1e-20f, ra = 0, rs = 0;
#pragma omp simd reduction(+ : aa, as, ss, ra, rs)
    for (int i = 0; i < count; i++) {
        float nl = n.x * lx[i] + n.y * ly[i] + n.z * lz[i], v = value[i];
        float nh = n.x * d->hx[i] + n.y * d->hy[i] + n.z * d->hz[i];
        float x = 1 - nh * nh, diffuse = nl > tau ? nl - tau : 0, lit = nl > 0 ? nl : 0;
        float height = lobe_at(&tail, u, x > 0 ? x : 0, lit, k);
        float r = v - a * diffuse - s * height, c = d->precision[i], q = 1 / (1 + r * r * c * narrow);
        float w = c * q * q, wd = w * diffuse, wh = w * height;
        aa += wd * diffuse;
        as += wd * height;
        ss += wh * height;
        ra += wd * v;
        rs += wh * v;
    }
    float determinant = aa * ss * 1.0001f - as * as;
    at->albedo = (ra * ss - rs * as) / determinant;
    at->gloss = (rs * aa - ra * as) / determinant;
    if (at->gloss < 0) {
        at->albedo = ra / aa;
        at->gloss = 0;
    } else if (at->albedo < 0) {
        at->albedo = 0;
        at->gloss = rs / ss;
    }
}

/* The sharpness that goes best with a start's normal. */
static pst_shading best_sharpness(const pst_lobe_data *d, const pst_lobe *lobe, const pst_shading *start)
{
    pst_shading best = *start;
    best.gloss = 0;
    best.sharpness = trial_sharpness[2];
    best.cost = loss(d, lobe, &best, widths[0]);
    for (int k = 0; k < TRIALS; k++) {
        pst_shading trial = *start;
        trial.sharpness = trial_sharpness[k];
        trial.gloss = 0;
        fit_heights(d, lobe, widths[0], &trial);
        fit_heights(d, lobe, widths[0], &trial);
        trial.cost = loss(d, lobe, &trial, widths[0]);
        if (trial.cost < best.cost) best = trial;
    }
    return best;
}

/* The normal half way to the brightest lights: what a mirror there would have. */
static vec3 mirror_normal(const pst_lobe_data *d)
{
    const pst_observations *o = &d->seen;
    float top = 0;
    for (int i = 0; i < o->padded; i++)
        top = o->value[i] > top ? o->value[i] : top;
    vec3 sum = {0, 0, 0};
    for (int i = 0; i < o->padded; i++) {
        float v = o->value[i]; /* the saturated too */
        if (v > 0.5f * top) sum = vec3_fma(sum, v * v, vec3_make(d->hx[i], d->hy[i], d->hz[i]));
    }
    return pst_facing(sum);
}

static pst_shading descend(const pst_lobe_data *d, const pst_lobe *lobe, const pst_shading *start)
{
    return narrow_down(d, lobe, best_sharpness(d, lobe, start), 1, 1e-2f);
}

pst_shading pst_lobe_fit(const pst_lobe_data *d, const pst_lobe *lobe)
{
    float weight[PST_MAX_LIGHTS];
    pst_observations lambert = d->seen;
    lambert.terminator = lobe->terminator;
    pst_pixel p = pst_pixel_fit(&lambert, weight);
    pst_shading start = {.normal = pst_facing(p.b), .albedo = vec3_length(p.b)};
    if (!(d->level > 0)) return start;
    pst_shading best = descend(d, lobe, &start);
    if (best.cost < 0.5f) return best;
    start.normal = mirror_normal(d);
    start.albedo = 0;
    pst_shading other = descend(d, lobe, &start);
    return other.cost < best.cost ? other : best;
}

pst_shading pst_lobe_search(const pst_lobe_data *d, const pst_lobe *lobe, const pst_shading *so_far)
{
    static const vec3 tilted[] = {{0.64f, 0, 0.768f},  {0.32f, 0.554f, 0.768f},   {-0.32f, 0.554f, 0.768f},
                                  {-0.64f, 0, 0.768f}, {-0.32f, -0.554f, 0.768f}, {0.32f, -0.554f, 0.768f}};
    pst_shading best = *so_far;
    for (size_t k = 0; k < sizeof tilted / sizeof *tilted; k++) {
        pst_shading found = descend(d, lobe, &(pst_shading){.normal = tilted[k]});
        if (found.cost < best.cost) best = found;
    }
    return best;
}

void pst_lobe_weigh(const pst_lobe_data *d, const pst_lobe *lobe, const pst_shading *at, float *weight, float *model)
{
    const float *lx = d->seen.x, *ly = d->seen.y, *lz = d->seen.z, *value = d->seen.value, *usable = d->seen.usable;
    const int count = pst_whole(d->seen.padded);
    const tail_choice tail = choose_tail(lobe->tail);
    const vec3 n = at->normal;
    const float u = expf(at->sharpness), tau = lobe->terminator, k = lobe->masking, a = at->albedo, s = at->gloss;
    const float narrow = 1 / (lobe->width * lobe->width);
#pragma omp simd
    for (int i = 0; i < count; i++) {
        float nl = n.x * lx[i] + n.y * ly[i] + n.z * lz[i];
        float nh = n.x * d->hx[i] + n.y * d->hy[i] + n.z * d->hz[i];
        float x = 1 - nh * nh, diffuse = nl > tau ? nl - tau : 0, lit = nl > 0 ? nl : 0;
        float fit = a * diffuse + s * lobe_at(&tail, u, x > 0 ? x : 0, lit, k);
        float r = value[i] - fit, q = 1 / (1 + r * r * d->precision[i] * narrow);
        model[i] = fit;
        weight[i] = (nl > tau ? usable[i] : 0) * q * q;
    }
}

float pst_lobe_foretell(const pst_observations *o, vec3 view, const pst_lobe *lobe)
{
    float usable[PST_MAX_LIGHTS], weight[PST_MAX_LIGHTS], model[PST_MAX_LIGHTS] = {0}, off = 0;
    pst_lobe_data all, some;
    pst_observations seen = *o;
    seen.usable = usable;
    pst_lobe_prepare(o, view, PST_SHADOW_COST, &all);
    for (int part = 0; part < PARTS; part++) {
        for (int i = 0; i < o->padded; i++)
            usable[i] = i % PARTS == part ? 0 : o->usable[i];
        pst_lobe_prepare(&seen, view, lobe->shadow, &some);
        pst_shading found = pst_lobe_fit(&some, lobe);
        pst_lobe_weigh(&some, lobe, &found, weight, model);
        for (int i = part; i < o->padded; i += PARTS) {
            float r = o->value[i] - model[i], t = r * r * all.precision[i];
            off += charge(all.shadowy[i], o->value[i], r) * sqrtf(t / (1 + t));
        }
    }
    return off;
}
