/* SPDX-License-Identifier: MIT */
#include "stereo/doubts/light_fit.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "optics/led.h"
#include "stereo/algebra/dense.h"
#include "stereo/capture/shrink.h"
#include "stereo/fit/pixel_fit.h"

/* Number of pixels that are used, up to four times as many. */
enum { SMALL = 3000 };
/* Share of full scale below which a pixel's values are noise. */
static const double dark = 0.003;

void pst_light_fit_free(pst_light_fit *f)
{
    pst_capture_free(&f->small);
    free(f->light);
    free(f->strength);
    free(f->gram);
    *f = (pst_light_fit){0};
}

/* ---- the lights ---- */

/* Returns the middle of the object in the camera's space. */
static vec3 middle_of(const merlin_capture *c, const merlin_surface *s)
{
    double x = 0, y = 0, depth = 0, count = 0;
    for (int row = 0; row < c->height; row++)
        for (int column = 0; column < c->width; column++) {
            size_t at = (size_t)row * (size_t)c->width + (size_t)column;
            if (c->mask.data[at] <= 0.5f) continue;
            x += column + 0.5;
            y += row + 0.5;
            depth += s->depth.data ? (double)s->depth.data[at] : (double)c->camera.distance;
            count++;
        }
    double scale = depth / count / (double)c->camera.focal;
    return vec3_make((float)((x / count - (double)c->camera.x) * scale),
                     (float)(((double)c->camera.y - y / count) * scale), (float)(-depth / count));
}

static vec3 near_light(const merlin_light *light, vec3 middle)
{
    float arriving;
    vec3 toward = led_light_at(vec3_of(light->position), vec3_of(light->direction), light->lobe, middle, &arriving);
    return vec3_scale(toward, arriving);
}

static float mean_intensity(const merlin_capture *c, const merlin_light *light)
{
    float sum = 0;
    for (int ch = 0; ch < c->channels; ch++)
        sum += light->intensity[ch];
    return sum > 0 ? sum / (float)c->channels : 1;
}

static status list_lights(const merlin_capture *c, const merlin_surface *s, pst_light_fit *f)
{
    const merlin_light *light = s->lights ? s->lights : c->light;
    vec3 middle = c->lighting == MERLIN_NEAR_LIGHTS ? middle_of(c, s) : (vec3){0, 0, 0};
    f->total = c->count;
    f->light = malloc((size_t)c->count * sizeof *f->light);
    f->strength = malloc((size_t)c->count * sizeof *f->strength);
    if (!f->light || !f->strength) return fail(MERLIN_NO_MEMORY, "no memory for %d lights", c->count);
    float most = 0;
    for (int k = 0; k < c->count; k++) {
        vec3 toward = c->lighting == MERLIN_NEAR_LIGHTS ? near_light(&light[k], middle) : vec3_of(light[k].direction);
        f->light[k] = vec3_scale(toward, mean_intensity(c, &light[k]));
        most = fmaxf(most, vec3_length(f->light[k]));
    }
    for (int k = 0; k < c->count; k++) {
        f->light[k] = vec3_scale(f->light[k], 1 / fmaxf(most, 1e-30f));
        f->strength[k] = mean_intensity(c, &light[k]);
    }
    return OK;
}

/* ---- the pictures ---- */

static status shrink(const merlin_capture *c, pst_light_fit *f)
{
    status s = pst_shrink_to(c, SMALL, PST_CHECKED_PICTURES, f->picture, &f->small);
    f->count = s == OK ? f->small.count : 0;
    return s;
}

/* Reads a pixel's values, the mean of the channels; below 0: saturated. Returns their length, 0 outside the object or
 * in the dark. */
static double values_at(const pst_light_fit *f, size_t pixel, float *value)
{
    const merlin_capture *c = &f->small;
    size_t channels = (size_t)c->channels;
    double square = 0;
    if (c->mask.data[pixel] <= 0.5f) return 0;
    for (int k = 0; k < f->count; k++) {
        float sum = 0;
        for (size_t ch = 0; ch < channels; ch++) {
            const uint16_t code = pst_code(&c->picture[k], pixel * channels + ch);
            sum = code >= PST_SATURATED * 65535 ? -HUGE_VALF : sum + (float)code;
        }
        value[k] = sum >= 0 ? sum / (65535 * (float)channels) : -1;
        square += (double)(value[k] * value[k]);
    }
    double length = sqrt(square);
    return length > dark * sqrt(f->count) ? length : 0;
}

static status sum_products(pst_light_fit *f)
{
    size_t n = (size_t)f->count, pixels = (size_t)f->small.width * (size_t)f->small.height;
    float value[PST_CHECKED_PICTURES];
    f->gram = calloc(n * n, sizeof *f->gram);
    if (!f->gram) return fail(MERLIN_NO_MEMORY, "no memory for %zu pictures' products", n);
    for (size_t i = 0; i < pixels; i++) {
        double length = values_at(f, i, value);
        if (!(length > 0)) continue;
        for (size_t j = 0; j < n; j++) /* a saturated value is at least that bright */
            for (size_t k = 0; k <= j; k++)
                f->gram[j * n + k] += fabs((double)(value[j] * value[k])) / (length * length);
    }
    for (size_t j = 0; j < n; j++) {
        f->energy += f->gram[j * n + j];
        for (size_t k = 0; k < j; k++)
            f->gram[k * n + j] = f->gram[j * n + k];
    }
    return OK;
}

status pst_light_fit_new(const merlin_capture *c, const merlin_surface *s, pst_light_fit *out)
{
    *out = (pst_light_fit){0};
    status result = list_lights(c, s, out);
    if (result == OK) result = shrink(c, out);
    if (result == OK) result = sum_products(out);
    if (result != OK) pst_light_fit_free(out);
    return result;
}

/* ---- explained energy ---- */

static double energy_of(const pst_light_fit *f, int without)
{
    size_t n = (size_t)f->count, k = (size_t)without;
    return f->energy - (without >= 0 ? f->gram[k * n + k] : 0);
}

/* Returns the energy explained by unit weights of the pictures. */
static double explained_by(const pst_light_fit *f, const double *along)
{
    size_t n = (size_t)f->count;
    double sum = 0;
    for (size_t j = 0; j < n; j++)
        for (size_t k = 0; k < n; k++)
            sum += along[j] * along[k] * f->gram[j * n + k];
    return sum;
}

double pst_light_fit_unexplained(const pst_light_fit *f, const vec3 *light, int without)
{
    double m[9] = {0}, eigenvalue[6], explained = 0;
    vec3 l[PST_CHECKED_PICTURES];
    for (int k = 0; k < f->count; k++) {
        l[k] = k == without ? (vec3){0, 0, 0} : light[f->picture[k]];
        const double v[3] = {l[k].x, l[k].y, l[k].z};
        for (int j = 0; j < 9; j++)
            m[j] += v[j / 3] * v[j % 3];
    }
    if (!dense_eigen(m, 3, true, eigenvalue)) return 1;
    for (int axis = 0; axis < 3; axis++) {
        double along[PST_CHECKED_PICTURES];
        if (!(eigenvalue[axis] > 1e-9 * eigenvalue[2])) continue;
        for (int k = 0; k < f->count; k++)
            along[k] = (l[k].x * m[axis] + l[k].y * m[3 + axis] + l[k].z * m[6 + axis]) / sqrt(eigenvalue[axis]);
        explained += explained_by(f, along);
    }
    return fmax(1 - explained / energy_of(f, without), 0);
}

double pst_light_fit_least(const pst_light_fit *f, int without)
{
    size_t n = (size_t)f->count;
    double *m = malloc(n * n * sizeof *m), value[2 * PST_CHECKED_PICTURES], left = 0;
    if (!m) return 0;
    memcpy(m, f->gram, n * n * sizeof *m);
    for (size_t k = 0; without >= 0 && k < n; k++)
        m[k * n + (size_t)without] = m[(size_t)without * n + k] = 0;
    bool found = dense_eigen(m, (int)n, false, value);
    for (size_t k = 0; found && k + 3 < n; k++)
        left += fmax(value[k], 0);
    free(m);
    return found ? left / energy_of(f, without) : 0;
}

void pst_light_fit_surface(const pst_light_fit *f, const vec3 *light, vec3 *b)
{
    enum { ROOM = PST_CHECKED_PICTURES + PST_LANES };
    float x[ROOM] = {0}, y[ROOM] = {0}, z[ROOM] = {0}, value[ROOM] = {0}, usable[ROOM] = {0}, weight[ROOM],
          power[ROOM] = {0};
    pst_observations o = {.padded = pst_padded(f->count), .x = x, .y = y, .z = z, .value = value, .usable = usable};
    for (int k = 0; k < f->count; k++) {
        vec3 l = light[f->picture[k]];
        power[k] = fmaxf(vec3_length(l), 1e-6f);
        x[k] = l.x / power[k];
        y[k] = l.y / power[k];
        z[k] = l.z / power[k];
    }
    size_t pixels = (size_t)f->small.width * (size_t)f->small.height;
    for (size_t i = 0; i < pixels; i++) {
        bool lit = values_at(f, i, value) > 0;
        for (int k = 0; k < f->count && lit; k++) {
            usable[k] = value[k] >= 0;
            value[k] = value[k] >= 0 ? value[k] / power[k] : 0;
        }
        b[i] = lit ? pst_pixel_fit(&o, weight).b : (vec3){0, 0, 0};
    }
}
