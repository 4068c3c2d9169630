/* SPDX-License-Identifier: MIT */
#include "estimate/light/found_light_fit.h"

#include <math.h>
#include <stdlib.h>

#include "estimate/light/found_light.h"
#include "optics/ambient.h"
#include "optics/light.h"
#include "optics/sh.h"

/* Pixels across, which are enough, and of the object, fewer of which tell too little; coefficients of the rest. */
enum { ACROSS = 28, LEAST_SPOTS = 40, COEFFICIENTS = 9 };
/* Sources of light; the third is even light while a lamp's place is searched for, and then the network's rest. */
enum { LAMP, FLASH, OTHER, SOURCES };
/* Share of white from which on a channel may be burnt out. */
static const float UNBURNT = 0.93f;
/* Residual, as a share of a value plus a tenth of the mean one, from which on it counts less. */
static const double PLAUSIBLE = 0.4, FLOOR = 0.1;
/* Weights of what the network tells: of one less the cosine to its direction, and of the squared difference in inverse
 * distance, in the logarithm of the residuals' cost. */
static const double TOLD_DIRECTION = 2, TOLD_DISTANCE = 0.33;
/* Weight of what the network tells of a room's coefficients, as a share of the mean weight of the pixels. */
static const double TOLD_ROOM = 0.2;
/* Largest factor of what the network tells of the rest beside a lamp, and of all light without one: where little of it
 * falls on the side that the camera sees, any factor explains the photograph. */
static const double MOST_OF_REST = 4, MOST_OF_ALL = 16;
/* So far aside the network tells a lamp's direction as well as this fit. */
static const float TRUSTED = 70 * DEGREE;

typedef struct spot {
    shade_input in;
    vec3 value, flash, rest; /* radiance; that under the flash at strength 1, and under the network's rest */
    float visible;
} spot;

typedef struct fitting {
    spot *spots;
    float *source[SOURCES], *value; /* of each spot, the channels' mean or one channel */
    int count;
    double floor; /* added to a value, of whose sum a residual is a share */
    vec3 told;    /* the network's direction, unit, */
    float told_inverse;
} fitting;

/* A lamp: unit direction from the object's middle, and inverse of its distance from there. */
typedef struct place {
    vec3 toward;
    float inverse;
    double cost;
} place;

/* ---- the object's pixels ---- */

static vec3 lit_by_rest(const shade_input *in, const float (*rest)[3])
{
    return vec3_add(ambient_diffuse(rest, in->albedo, in->normal),
                    ambient_specular(rest, in->roughness, in->normal, vec3_normalize(vec3_scale(in->ray, -1))));
}

static vec3 lit_by_flash(const shade_input *without)
{
    shade_input in = *without;
    in.light = vec3_make(0, 0, 0);
    in.power = LIGHT_POWER;
    return shade_point(&in);
}

static void add_spot(const lit_photo *of, const float (*rest)[3], int x, int y, fitting *f)
{
    const surface *m = of->maps;
    const camera c = surface_camera(m);
    const vec3 value = vec3_of(img_at(of->photo, x, y));
    if (!(*img_at(&m->mask, x, y) > 0.5f) || !(found_light_mean(value) > 0)) return;
    if (fmaxf(value.x, fmaxf(value.y, value.z)) > UNBURNT * of->white) return;
    spot *s = &f->spots[f->count++];
    s->in = (shade_input){.albedo = vec3_of(img_at(&m->albedo, x, y)),
                          .roughness = *img_at(&m->roughness, x, y),
                          .normal = vec3_of(img_at(&m->normal, x, y)),
                          .depth = *img_at(&m->depth, x, y),
                          .ray = camera_point(&c, (float)x + 0.5f, (float)y + 0.5f, 1)};
    s->value = value;
    s->flash = lit_by_flash(&s->in);
    s->rest = lit_by_rest(&s->in, rest);
    s->visible = of->visibility->data ? *img_at(of->visibility, x, y) : 1;
}

static void fitting_free(fitting *f)
{
    free(f->spots);
    free(f->value);
}

static status fitting_new(const lit_photo *of, const float code[MODEL_LIGHTS], fitting *f)
{
    const int size = of->maps->mask.width, step = size > ACROSS ? size / ACROSS : 1;
    const int across = (size + step - 1) / step;
    const size_t most = (size_t)across * (size_t)across;
    float rest[COEFFICIENTS][3];
    *f = (fitting){.told = vec3_normalize(vec3_of(code + MODEL_LIGHTS_LAMP)),
                   .told_inverse = fmaxf(code[MODEL_LIGHTS_DISTANCE], 0),
                   .spots = calloc(most, sizeof *f->spots),
                   .value = calloc(most * (SOURCES + 1), sizeof *f->value)};
    if (!f->spots || !f->value) {
        fitting_free(f);
        return fail(MERLIN_NO_MEMORY, "no memory to fit a photograph's light");
    }
    for (int s = 0; s < SOURCES; s++)
        f->source[s] = f->value + most * (size_t)(s + 1);
    model_decode_sh(code + MODEL_LIGHTS_REST, rest);
    for (int y = 0; y < size; y += step)
        for (int x = 0; x < size; x += step)
            add_spot(of, (const float(*)[3])rest, x, y, f);
    return OK;
}

/* Lights a spot by a lamp that is as strong in the object's middle, whatever its distance. */
static vec3 lit_by_lamp(const spot *s, const place *at)
{
    shade_input in = s->in;
    const float from_middle = found_light_distance(at->inverse), distance = from_middle > 0 ? from_middle : 1;
    in.light = vec3_fma(from_middle > 0 ? object_middle : vec3_scale(in.ray, in.depth), distance, at->toward);
    in.power = LIGHT_POWER * distance * distance;
    return vec3_scale(shade_point(&in), s->visible);
}

/* ---- strengths ---- */

/* Largest strengths of the sources. */
static const double FREE[SOURCES] = {HUGE_VAL, HUGE_VAL, HUGE_VAL},
                    BESIDE_LAMP[SOURCES] = {HUGE_VAL, HUGE_VAL, MOST_OF_REST};

/* Minimizes |A x - b|² of x from 0 to `most` (NULL: any x), given AᵀA and Aᵀb, one unknown after the other. */
static void solve(int n, double (*a)[COEFFICIENTS], const double *b, const double *most, double *x)
{
    double change = 1;
    for (int turn = 0; turn < 200 && change > 1e-5; turn++) {
        change = 0;
        for (int i = 0; i < n; i++) {
            double left = b[i];
            for (int j = 0; j < n; j++)
                left -= j == i ? 0 : a[i][j] * x[j];
            double next = a[i][i] > 0 ? left / a[i][i] : 0;
            if (most) next = fmin(fmax(next, 0), most[i]);
            change = fmax(change, fabs(next - x[i]) / (fabs(next) + 1e-3));
            x[i] = next;
        }
    }
}

/* Returns the light of the first n sources on a spot, less its value. */
static double residual(const fitting *f, int n, const double *x, int i)
{
    double lit = 0;
    for (int s = 0; s < n; s++)
        lit += x[s] * (double)f->source[s][i];
    return lit - (double)f->value[i];
}

/* Returns the size that a spot's residual is a share of. */
static double scale_of(const fitting *f, int i)
{
    return (double)f->value[i] + f->floor;
}

/* Returns a spot's weight in least squares, by what the last strengths leave unexplained of it. */
static double weight_of(const fitting *f, int i, double left)
{
    const double scale = scale_of(f, i), r = left / scale / PLAUSIBLE;
    return 1 / (scale * scale * sqrt(1 + r * r));
}

/* Sums up the equations of all sources, each weighted by how well the last strengths explain it. */
static void sum_equations(const fitting *f, const double x[SOURCES], bool first, double (*a)[COEFFICIENTS],
                          double b[SOURCES])
{
    for (int i = 0; i < f->count; i++) {
        const double weight = weight_of(f, i, first ? 0 : residual(f, SOURCES, x, i));
        for (int s = 0; s < SOURCES; s++) {
            const double of = weight * (double)f->source[s][i];
            b[s] += of * (double)f->value[i];
            for (int t = 0; t < SOURCES; t++)
                a[s][t] += of * (double)f->source[t][i];
        }
    }
}

/* Fits the sources' strengths to the values, and returns the mean cost of what is left. */
static double fit_strengths(fitting *f, const double most[SOURCES], double x[SOURCES])
{
    enum { PASSES = 4 };
    double sum = 0, cost = 0;
    for (int i = 0; i < f->count; i++)
        sum += (double)f->value[i];
    f->floor = FLOOR * sum / f->count;
    for (int s = 0; s < SOURCES; s++)
        x[s] = 0;
    for (int pass = 0; pass < PASSES; pass++) {
        double a[SOURCES][COEFFICIENTS] = {{0}}, b[SOURCES] = {0};
        sum_equations(f, x, pass == 0, a, b);
        solve(SOURCES, a, b, most, x);
    }
    for (int i = 0; i < f->count; i++) {
        const double r = residual(f, SOURCES, x, i) / scale_of(f, i) / PLAUSIBLE;
        cost += log1p(r * r);
    }
    return cost / f->count;
}

/* ---- the lamp's place ---- */

static void judge(fitting *f, place *at)
{
    double x[SOURCES];
    for (int i = 0; i < f->count; i++)
        f->source[LAMP][i] = found_light_mean(lit_by_lamp(&f->spots[i], at));
    const double from_told = (double)(at->inverse - f->told_inverse);
    at->cost = log(fit_strengths(f, FREE, x) + 1e-6) + TOLD_DIRECTION * (1 - (double)vec3_dot(at->toward, f->told)) +
               TOLD_DISTANCE * from_told * from_told;
}

/* Finds the best of nine places: as far aside as the network tells or less, and to other sides. */
static place first_place(fitting *f)
{
    const float aside = acosf(fminf(fmaxf(f->told.z, -1), 1)), way = atan2f(f->told.y, f->told.x);
    place best = {.cost = HUGE_VAL};
    for (int i = 0; i < 9; i++) {
        static const float less[3] = {1, 0.6f, 0.3f};
        const float a = aside * less[i / 3], w = way + 30 * DEGREE * (float)(i % 3 - 1);
        place at = {.toward = {sinf(a) * cosf(w), sinf(a) * sinf(w), cosf(a)}, .inverse = f->told_inverse};
        judge(f, &at);
        if (at.cost < best.cost) best = at;
    }
    return best;
}

/* Tries the six neighbours of a place, and goes to each that is better. */
static bool go_on(fitting *f, float step, float nearer, place *at)
{
    bool moved = false;
    const vec3 across =
        vec3_normalize(vec3_cross(fabsf(at->toward.y) < 0.9f ? vec3_make(0, 1, 0) : vec3_make(1, 0, 0), at->toward));
    const vec3 ways[2] = {across, vec3_cross(at->toward, across)};
    for (int i = 0; i < 6; i++) {
        const float by = i % 2 ? -1 : 1;
        place next = *at;
        if (i < 4)
            next.toward = vec3_normalize(vec3_fma(at->toward, by * tanf(step), ways[i / 2]));
        else
            next.inverse = fmaxf(at->inverse + by * nearer, 0);
        judge(f, &next);
        if (!(next.cost < at->cost - 1e-5)) continue;
        *at = next;
        moved = true;
    }
    return moved;
}

static place best_place(fitting *f)
{
    if (f->told.z < cosf(TRUSTED)) return (place){f->told, f->told_inverse, 0};
    for (int i = 0; i < f->count; i++) { /* in the channels' mean, which tells it as well as each channel would */
        f->value[i] = found_light_mean(f->spots[i].value);
        f->source[FLASH][i] = found_light_mean(f->spots[i].flash);
        f->source[OTHER][i] = found_light_mean(f->spots[i].in.albedo); /* from everywhere, as bounces are about */
    }
    place at = first_place(f);
    float nearer = 0.25f, step = 14 * DEGREE;
    for (int turn = 0; turn < 60 && step > 1.2f * DEGREE; turn++)
        if (!go_on(f, step, nearer, &at)) step /= 2, nearer /= 2;
    return at;
}

/* ---- the result ---- */

static float channel_of(vec3 v, int c)
{
    return c == 0 ? v.x : c == 1 ? v.y : v.z;
}

/* Fits the strengths of lamp, flash and the network's rest in one channel. */
static void fit_channel(fitting *f, const place *at, int c, double x[SOURCES])
{
    for (int i = 0; i < f->count; i++) {
        const spot *s = &f->spots[i];
        f->value[i] = channel_of(s->value, c);
        f->source[LAMP][i] = channel_of(lit_by_lamp(s, at), c);
        f->source[FLASH][i] = channel_of(s->flash, c);
        f->source[OTHER][i] = channel_of(s->rest, c);
    }
    fit_strengths(f, BESIDE_LAMP, x);
}

/* Scales all light of one channel, as it is told, to the photograph's brightness: how much of it is flash, and how much
 * comes from everywhere, the network knows better. Sums are compared, as residuals by share of the values lean to the
 * dark pixels where the maps do not explain the light. */
static double fit_whole(fitting *f, float flash, int c)
{
    double seen = 0, told = 0;
    for (int i = 0; i < f->count; i++) {
        const spot *s = &f->spots[i];
        f->value[i] = channel_of(s->value, c);
        f->source[0][i] = flash * channel_of(s->flash, c) + channel_of(s->rest, c);
        seen += (double)f->value[i];
        told += (double)f->source[0][i];
    }
    f->floor = FLOOR * seen / f->count;
    return told > 0 ? fmin(seen / told, MOST_OF_ALL) : 0;
}

/* Scales the rest by channel, and adds to its coefficients, as far as it stays light. */
static void change_rest(const double by[3], double (*add)[COEFFICIENTS], float code[MODEL_LIGHTS])
{
    float rest[COEFFICIENTS][3];
    model_decode_sh(code + MODEL_LIGHTS_REST, rest);
    for (int k = 0; k < COEFFICIENTS; k++)
        for (int c = 0; c < 3; c++)
            rest[k][c] = (float)(by[c] * (double)rest[k][c] + add[c][k]);
    sh_hold_positive(rest);
    model_encode_sh((const float(*)[3])rest, code + MODEL_LIGHTS_REST);
}

/* Finds what has to be added to a room's coefficients, in the channel of the values, for the only source, so many
 * times as strong, to explain them. */
static void fit_room(const fitting *f, int c, double by, double change[COEFFICIENTS])
{
    double a[COEFFICIENTS][COEFFICIENTS] = {{0}}, b[COEFFICIENTS] = {0}, mean = 0;
    for (int i = 0; i < f->count; i++) {
        const spot *s = &f->spots[i];
        real basis[COEFFICIENTS];
        const double left = -residual(f, 1, &by, i), weight = weight_of(f, i, left);
        sh_basis(s->in.normal, basis);
        for (int k = 0; k < COEFFICIENTS; k++)
            basis[k] *= sh_cosine_band(k) * channel_of(s->in.albedo, c) / PI;
        for (int k = 0; k < COEFFICIENTS; k++) {
            b[k] += weight * (double)basis[k] * left;
            for (int j = 0; j < COEFFICIENTS; j++)
                a[k][j] += weight * (double)(basis[k] * basis[j]);
        }
    }
    for (int k = 0; k < COEFFICIENTS; k++)
        mean += a[k][k] / COEFFICIENTS;
    for (int k = 0; k < COEFFICIENTS; k++)
        a[k][k] += TOLD_ROOM * mean, change[k] = 0;
    solve(COEFFICIENTS, a, b, NULL, change);
}

/* Tells whether most of the light comes from a room. */
static bool is_room(const float code[MODEL_LIGHTS])
{
    merlin_found_light light;
    found_light_take(code, &light);
    const found_light_shares share = found_light_share(&light);
    return share.rest > share.flash;
}

static void put_whole(fitting *f, float code[MODEL_LIGHTS])
{
    const float flash = model_decode_strength(code[MODEL_LIGHTS_FLASH]);
    const bool room = is_room(code);
    double by[3], change[3][COEFFICIENTS] = {{0}};
    for (int c = 0; c < 3; c++) {
        by[c] = fit_whole(f, flash, c);
        if (room) fit_room(f, c, by[c], change[c]);
    }
    const double mean = (by[0] + by[1] + by[2]) / 3;
    if (!(mean > 0)) return;
    change_rest(by, change, code);
    code[MODEL_LIGHTS_FLASH] = model_encode_strength((float)mean * flash);
}

static void put_all(fitting *f, const place *at, float code[MODEL_LIGHTS])
{
    double x[3][SOURCES], rest[3], none[3][COEFFICIENTS] = {{0}}, of_lamp = 0, of_flash = 0;
    for (int c = 0; c < 3; c++) {
        fit_channel(f, at, c, x[c]);
        of_lamp += x[c][LAMP] / 3;
        of_flash += x[c][FLASH] / 3;
        rest[c] = x[c][OTHER];
    }
    if (!(of_lamp > 0)) return;
    change_rest(rest, none, code);
    for (int c = 0; c < 3; c++)
        code[MODEL_LIGHTS_STRENGTH + c] = model_encode_strength((float)x[c][LAMP]);
    code[MODEL_LIGHTS_FLASH] = model_encode_strength((float)of_flash);
    const float sure = vec3_length(vec3_of(code + MODEL_LIGHTS_LAMP));
    vec3_put(vec3_scale(at->toward, sure), code + MODEL_LIGHTS_LAMP);
    code[MODEL_LIGHTS_DISTANCE] = at->inverse;
}

/* Makes light of what the network tells of the rest, whose coefficients may be any. */
static void hold_rest(float code[MODEL_LIGHTS])
{
    float rest[COEFFICIENTS][3];
    model_decode_sh(code + MODEL_LIGHTS_REST, rest);
    sh_hold_positive(rest);
    model_encode_sh((const float(*)[3])rest, code + MODEL_LIGHTS_REST);
}

status found_light_fit(const lit_photo *of, float code[MODEL_LIGHTS])
{
    fitting f;
    hold_rest(code);
    status s = fitting_new(of, code, &f);
    if (s != OK) return s;
    if (f.count >= LEAST_SPOTS && found_light_has_lamp(code)) {
        const place at = best_place(&f);
        put_all(&f, &at, code);
    } else if (f.count >= LEAST_SPOTS) {
        put_whole(&f, code);
    }
    fitting_free(&f);
    return OK;
}
