/* SPDX-License-Identifier: MIT */
#include "lab/train/samples/mixture.h"

#include <math.h>
#include <string.h>

#include "base/number.h"
#include "image/color.h"
#include "optics/blackbody.h"
#include "optics/light.h"
#include "optics/sh.h"

/* Share of the light from which on a lamp counts as fully present. */
static const float LAMP_SHARE = 1.0f / 6;
static const float ROOM_ALONE = 1.0f / 6;           /* share of photographs in the light of the surroundings alone */
static const float COLDEST = 10000, WARMEST = 2500; /* colour temperatures of lamps, kelvin */
/* Range of automatic exposure: logarithm of the 95th percentile of the object's radiance over the sensor's white; a
 * camera exposes for the whole frame, whose content is unknown. */
static const float DARKEST = -1.5f, BRIGHTEST = 0.15f;

static vec3 scaled(vec3 color, float by)
{
    return vec3_scale(color, by);
}

static const float *lamp_pixel(const train_view *v, int which, size_t i)
{
    const size_t pixels = (size_t)v->size * (size_t)v->size;
    return v->lamps + TRAIN_LAMP_VALUES * ((size_t)which * pixels + i);
}

/* ---- the light ------------------------------------------------------------------------------------------------- */

/* Mean luminance over the object of the flash, the surroundings and every lamp. */
typedef struct means {
    float flash, room, lamp[TRAIN_LAMPS];
} means;

static means measure(const train_view *v)
{
    double flash = 0, room = 0, lit[TRAIN_LAMPS] = {0}, count = 1e-6;
    for (size_t i = 0; i < (size_t)v->size * (size_t)v->size; i++) {
        if (v->mask[i] <= 0.5f) continue;
        count++;
        flash += (double)(color_luminance(v->direct + 3 * i) + color_luminance(v->indirect + 3 * i));
        room += (double)color_luminance(v->env + 3 * i);
        for (int k = 0; k < v->lamp_count; k++)
            lit[k] += (double)color_luminance(lamp_pixel(v, k, i));
    }
    means m = {(float)(flash / count), (float)(room / count), {0}};
    for (int k = 0; k < v->lamp_count; k++)
        m.lamp[k] = (float)(lit[k] / count);
    return m;
}

/* Returns the least mean by which a light is divided: one that hardly reaches the visible side is not amplified beyond
 * what all other lights give. */
static float least_mean(const means *m)
{
    return 0.1f * m->flash + 1e-6f;
}

static vec3 draw_color(rng *r)
{
    float kelvin = WARMEST * powf(COLDEST / WARMEST, rng_uniform(r));
    vec3 color = blackbody_color(kelvin);
    return vec3_scale(color, 1 / (0.2126f * color.x + 0.7152f * color.y + 0.0722f * color.z));
}

/* Returns a log-uniform weight, from hardly visible to full strength. */
static float draw_weight(rng *r)
{
    return expf(rng_range(r, -2.7f, 0));
}

/* Chooses the lights that are on, at least one of them, and their weights. */
static void draw_shares(const train_view *v, rng *r, float *flash, float *room, float shares[TRAIN_LAMPS])
{
    float how_many = rng_uniform(r), with_flash = rng_uniform(r), with_room = rng_uniform(r);
    int lamps = how_many < 0.12f ? 0 : how_many < 0.75f ? 1 : 2, first = rng_below(r, v->lamp_count);
    *flash = with_flash < 0.35f || (lamps == 0 && with_flash < 0.7f) ? draw_weight(r) : 0;
    *room = with_room < 0.7f || lamps == 0 ? draw_weight(r) : 0;
    for (int k = 0; k < lamps && k < v->lamp_count; k++)
        shares[(first + k) % v->lamp_count] = draw_weight(r);
}

/* Switches flash and surroundings on, by their weights. */
static void put_flash_and_room(const means *m, float flash, float room, train_mixture *out)
{
    const float least = least_mean(m);
    out->flash = scaled(vec3_make(1, 1, 1), flash / fmaxf(m->flash, least));
    out->room = scaled(vec3_make(1, 1, 1), room / fmaxf(m->room, least));
}

static void draw_mixed(const train_view *v, const means *m, rng *r, train_mixture *out)
{
    float flash = 0, room = 0, shares[TRAIN_LAMPS] = {0};
    draw_shares(v, r, &flash, &room, shares);
    const float least = least_mean(m);
    put_flash_and_room(m, flash, room, out);
    for (int k = 0; k < v->lamp_count; k++)
        out->lamp[k] = scaled(draw_color(r), shares[k] / fmaxf(m->lamp[k], least));
}

static float luminance_of(vec3 v)
{
    return 0.2126f * v.x + 0.7152f * v.y + 0.0722f * v.z;
}

/* Returns the mean luminance of all light together in the picture. */
static float amount_of(const train_view *v, const means *m, const train_mixture *of)
{
    float all = luminance_of(of->flash) * m->flash + luminance_of(of->room) * m->room;
    for (int k = 0; k < v->lamp_count; k++)
        all += luminance_of(of->lamp[k]) * m->lamp[k];
    return all;
}

/* Ensures that the picture is lit: with only lamps behind the object it would be black. */
static void ensure_light(const train_view *v, const means *m, train_mixture *out)
{
    if (amount_of(v, m, out) < 1e-3f * m->flash + 1e-6f)
        *out = (train_mixture){.kind = TRAIN_FLASH, .flash = {1, 1, 1}};
}

/* Finds the lamp that gives most light, and how certainly it is present. */
static void find_strongest(const train_view *v, const means *m, train_mixture *out)
{
    const float all = amount_of(v, m, out);
    float most = 0;
    out->strongest = -1;
    for (int k = 0; k < v->lamp_count; k++) {
        float light = luminance_of(out->lamp[k]) * m->lamp[k];
        if (light > most) {
            most = light;
            out->strongest = k;
        }
    }
    out->presence = all > 0 ? fminf(most / (all * LAMP_SHARE), 1) : 0;
    if (out->presence <= 0) out->strongest = -1;
}

static vec3 mixed_at(const train_view *v, const train_mixture *m, size_t i)
{
    vec3 flash = vec3_add(vec3_of(v->direct + 3 * i), vec3_of(v->indirect + 3 * i));
    vec3 sum = vec3_add(vec3_mul(m->flash, flash), vec3_mul(m->room, vec3_of(v->env + 3 * i)));
    for (int k = 0; k < v->lamp_count; k++)
        sum = vec3_add(sum, vec3_mul(m->lamp[k], vec3_of(lamp_pixel(v, k, i))));
    return sum;
}

/* ---- the camera's choices -------------------------------------------------------------------------------------- */

/* Returns the 95th percentile of the object's radiance, or the mean of all light if that is more: with a lamp that
 * reaches only a rim 95 % of the pixels are black, which gives no exposure. */
static float bright_part(const train_view *v, const train_mixture *m, float mean)
{
    enum { BINS = 512 };
    size_t bins[BINS] = {0}, count = 0, below = 0;
    for (size_t i = 0; i < (size_t)v->size * (size_t)v->size; i++) {
        if (v->mask[i] <= 0.5f) continue;
        float place = (log2f(fmaxf(luminance_of(mixed_at(v, m, i)), 1e-9f)) + 30) * 8;
        bins[(int)clamp(place, 0, BINS - 1)]++;
        count++;
    }
    int bin = 0;
    while (bin < BINS - 1 && (below += bins[bin]) <= count * 95 / 100)
        bin++;
    return fmaxf(exp2f(((float)bin + 0.5f) / 8 - 30), mean);
}

/* Applies white balance, by most of what would make the light white. */
static void balance(vec3 light, float share, float gain[3])
{
    float mean = luminance_of(light);
    const float channel[3] = {light.x, light.y, light.z};
    for (int c = 0; c < 3; c++)
        gain[c] *= powf(mean / fmaxf(channel[c], 1e-3f * mean), share);
}

/* Returns the colour of all light together, weighted by its luminance in the picture. */
static vec3 color_of(const train_view *v, const means *m, const train_mixture *mix)
{
    vec3 room = vec3_make(v->sh[0], v->sh[1], v->sh[2]), sum = vec3_scale(mix->flash, m->flash);
    float bright = fmaxf(luminance_of(room), 1e-6f);
    sum = vec3_add(sum, vec3_scale(vec3_mul(mix->room, room), m->room / bright));
    for (int k = 0; k < v->lamp_count; k++)
        sum = vec3_add(sum, vec3_scale(mix->lamp[k], m->lamp[k]));
    return sum;
}

train_capture train_capture_draw(rng *steady, int picture)
{
    train_capture c = {.torch = rng_uniform(steady) < 0.6f, .picture = picture};
    const bool dark = rng_uniform(steady) < 0.5f;
    const float room = draw_weight(steady);
    c.lamp = rng_below(steady, TRAIN_LAMPS);
    c.room = dark ? 0 : 0.5f * room;
    c.color = draw_color(steady);
    return c;
}

/* Lights a picture by its own lamp, which a hand holds nearer or farther, and by the surroundings of all pictures. */
static void draw_torch(const train_view *v, const means *m, const train_capture *c, rng *r, train_mixture *out)
{
    const float least = least_mean(m), strength = expf(rng_range(r, -0.7f, 0));
    const int which = (c->lamp + c->picture) % v->lamp_count;
    put_flash_and_room(m, 0, c->room, out);
    out->lamp[which] = scaled(c->color, strength / fmaxf(m->lamp[which], least));
}

/* Chooses which of the kinds of light a photograph shows; which: uniform in [0, 1). */
static void draw_kind(const train_view *v, const means *m, const train_config *c, float which, rng *r,
                      train_mixture *out)
{
    const float flash = (float)c->flash_alone, room = flash + ROOM_ALONE, both = room + (float)c->flash_in_room;
    if (which < flash) {
        out->kind = TRAIN_FLASH;
        out->flash = vec3_make(1, 1, 1);
    } else if (which < room) {
        out->kind = TRAIN_ROOM;
        out->room = vec3_make(1, 1, 1);
    } else if (which < both) {
        const float weight = draw_weight(r);
        put_flash_and_room(m, weight, draw_weight(r), out);
    } else if (which < both + (float)c->lamp_alone) {
        const int k = rng_below(r, v->lamp_count);
        out->lamp[k] = scaled(draw_color(r), 1 / fmaxf(m->lamp[k], least_mean(m)));
    } else {
        draw_mixed(v, m, r, out);
    }
}

void train_mixture_draw(const train_view *v, const train_config *c, rng *r, const train_capture *capture,
                        train_camera *lens, train_mixture *out)
{
    const bool torch = capture && capture->torch, further = capture && capture->picture > 0;
    const means m = measure(v);
    float which = rng_uniform(r), target = expf(rng_range(r, DARKEST, BRIGHTEST)), share = rng_range(r, 0.5f, 1);
    bool known = rng_uniform(r) < 0.75f, told = rng_uniform(r) < 0.5f;
    *out = (train_mixture){.kind = TRAIN_MIXED};
    if (torch)
        draw_torch(v, &m, capture, r, out);
    else if (further)
        draw_mixed(v, &m, r, out);
    else
        draw_kind(v, &m, c, which, r, out);
    ensure_light(v, &m, out);
    find_strongest(v, &m, out);
    out->lens_known = known;
    out->told_flash = told && out->kind == TRAIN_FLASH;
    if (out->kind == TRAIN_FLASH) return; /* exposed as rendered, which tells dark objects from bright ones */
    balance(color_of(v, &m, out), share, lens->gain);
    float exposure = target * lens->white / bright_part(v, out, amount_of(v, &m, out));
    for (int k = 0; k < 3; k++)
        lens->gain[k] *= exposure;
}

/* ---- targets: what the network has to predict about the light ------------------------------------------------------
 */

static vec3 way_to(const train_lamp *l)
{
    return l->distant ? l->at : vec3_sub(l->at, vec3_make(0, 0, -1));
}

/* Adds a lamp's light, as parallel light, to the coefficients of the surroundings. */
static void add_lamp(const train_lamp *l, vec3 strength, float sh[9][3])
{
    sh_accumulate(sh, vec3_normalize(way_to(l)), vec3_scale(strength, LIGHT_POWER));
}

static void put_rest(const train_view *v, const train_mixture *m, vec3 gain)
{
    float sh[9][3], all = 0;
    const vec3 room = vec3_mul(m->room, gain);
    for (int i = 0; i < 9; i++) {
        sh[i][0] = v->sh[3 * i] * room.x;
        sh[i][1] = v->sh[3 * i + 1] * room.y;
        sh[i][2] = v->sh[3 * i + 2] * room.z;
    }
    for (int k = 0; k < v->lamp_count; k++)
        add_lamp(&v->lamp[k], vec3_scale(vec3_mul(m->lamp[k], gain), k == m->strongest ? 1 - m->presence : 1), sh);
    float *code = v->lights + MODEL_LIGHTS_REST;
    model_encode_sh((const float(*)[3])sh, code);
    for (int i = 0; i < MODEL_SH; i++)
        all += code[i] * code[i];
    v->rest_weight[0] = 1 / (1 + all); /* light on a dark object is strong, and its error larger */
}

static void put_lights(const train_view *v, const train_mixture *m, const train_camera *lens)
{
    const vec3 gain = vec3_of(lens->gain), flash = vec3_mul(m->flash, gain);
    memset(v->lights, 0, MODEL_LIGHTS * sizeof *v->lights);
    v->lights[MODEL_LIGHTS_FLASH] = model_encode_strength(luminance_of(flash));
    v->lamp_weight[0] = m->presence;
    put_rest(v, m, gain);
    if (m->strongest < 0) return;
    const vec3 way = way_to(&v->lamp[m->strongest]), strength = vec3_mul(m->lamp[m->strongest], gain);
    const float distance = vec3_length(way);
    vec3_put(vec3_scale(way, m->presence / distance), v->lights + MODEL_LIGHTS_LAMP);
    v->lights[MODEL_LIGHTS_DISTANCE] = v->lamp[m->strongest].distant ? 0 : 1 / distance;
    const float channel[3] = {strength.x, strength.y, strength.z};
    for (int c = 0; c < 3; c++)
        v->lights[MODEL_LIGHTS_STRENGTH + c] = model_encode_strength(m->presence * channel[c]);
}

/* Sets the strongest lamp's visibility and its weight: where the lamp would be seen, by how much it matters. Maps are
 * as unpacked. */
static void put_visibility(const train_view *v, const train_mixture *m)
{
    size_t pixels = (size_t)v->size * (size_t)v->size;
    memset(v->visibility, 0, pixels * sizeof *v->visibility);
    memset(v->visibility_weight, 0, pixels * sizeof *v->visibility_weight);
    if (m->strongest < 0 || m->presence < 0.5f) return;
    const train_lamp *l = &v->lamp[m->strongest];
    for (size_t i = 0; i < pixels; i++) {
        if (v->mask[i] < 0.999f) continue;
        int x = (int)(i % (size_t)v->size), y = (int)(i / (size_t)v->size);
        vec3 p = camera_point(&v->lens, (float)x + 0.5f, (float)y + 0.5f, v->depth[i]);
        vec3 toward = vec3_normalize(l->distant ? l->at : vec3_sub(l->at, p));
        v->visibility[i] = lamp_pixel(v, m->strongest, i)[3];
        v->visibility_weight[i] = vec3_dot(toward, vec3_of(v->normal + 3 * i)) > 0.02f ? m->presence : 0;
    }
}

static void put_sight(const train_view *v, const train_mixture *m)
{
    model_sight(m->lens_known ? &v->lens : NULL, m->told_flash, v->size, v->sight);
    v->lens_values[0] = camera_tangent(v->lens.fov);
    v->lens_values[1] = v->lens.slant.right;
    v->lens_values[2] = v->lens.slant.up;
}

/* Converts distance to relief, as nn_render defines it. */
static void put_relief(const train_view *v)
{
    float scale = camera_tangent(CAMERA_FOV) / camera_tangent(v->lens.fov);
    for (size_t i = 0; i < (size_t)v->size * (size_t)v->size; i++)
        if (v->mask[i] > 0) v->depth[i] = 1 + (v->depth[i] - 1) * scale;
}

/* Shift of a picture of SHIFT_SIZE pixels, at most. */
static const float SHIFT = 2, SHIFT_SIZE = 256;

void train_mixture_move(int size, rng *steady, rng *r, train_mixture *out)
{
    const float most = rng_uniform(steady) < 1.0f / 3 ? 0 : SHIFT * (float)size / SHIFT_SIZE;
    for (int k = 0; k < 2; k++)
        out->shift[k] = most * rng_range(r, -1, 1);
}

/* Returns a picture's value between pixels; zero outside the frame. */
static vec3 value_at(const float *picture, int size, float x, float y)
{
    const float left = floorf(x), top = floorf(y);
    vec3 sum = {0, 0, 0};
    for (int k = 0; k < 4; k++) {
        const int column = (int)left + k % 2, row = (int)top + k / 2;
        if (column < 0 || column >= size || row < 0 || row >= size) continue;
        const float across = k % 2 ? x - left : 1 - (x - left), down = k / 2 ? y - top : 1 - (y - top);
        const float *pixel = picture + 3 * ((size_t)row * (size_t)size + (size_t)column);
        sum = vec3_add(sum, vec3_scale(vec3_of(pixel), across * down));
    }
    return sum;
}

/* Shifts the photograph against mask and maps. */
static void shift_photo(const train_view *v, const float shift[2])
{
    if (shift[0] == 0 && shift[1] == 0) return;
    const size_t pixels = (size_t)v->size * (size_t)v->size;
    float *held = v->reconstruction; /* which is computed later */
    memcpy(held, v->photo, 3 * pixels * sizeof *held);
    for (size_t i = 0; i < pixels; i++) {
        const size_t column = i % (size_t)v->size, row = i / (size_t)v->size;
        const vec3 value = value_at(held, v->size, (float)column - shift[0], (float)row - shift[1]);
        vec3_put(value, v->photo + 3 * i);
    }
}

status train_prepare_any(const train_view *v, const train_mixture *m, const train_camera *lens, vec3 target, rng *noise)
{
    for (size_t i = 0; i < (size_t)v->size * (size_t)v->size; i++)
        vec3_put(mixed_at(v, m, i), v->photo + 3 * i);
    shift_photo(v, m->shift);
    status s = train_photograph(v, true, lens, noise);
    if (s != OK) return s;
    put_lights(v, m, lens);
    put_visibility(v, m);
    put_sight(v, m);
    train_finish(v, target);
    put_relief(v);
    return OK;
}
