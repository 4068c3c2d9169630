/* SPDX-License-Identifier: MIT */
#include "estimate/light/found_light.h"

#include <math.h>

#include "estimate/light/relight_env.h"
#include "estimate/light/shadow.h"
#include "optics/camera.h"
#include "optics/latlong.h"
#include "optics/sh.h"

/* Least probability for a lamp to count; largest distance, beyond which its light is parallel; and the share of the
 * flash from which on there is no other light. */
static const float LEAST_SURE = 0.5f, FARTHEST = 20, FLASH_ALONE = 0.93f;

void found_light_take(const float code[MODEL_LIGHTS], merlin_found_light *out)
{
    const vec3 toward = vec3_of(code + MODEL_LIGHTS_LAMP);
    const float sure = vec3_length(toward);
    const bool kept = found_light_has_lamp(code);
    *out = (merlin_found_light){.known = 1, .flash = model_decode_strength(code[MODEL_LIGHTS_FLASH])};
    out->lamp_sure = sure < 1 ? sure : 1;
    if (kept) vec3_put(vec3_scale(toward, 1 / sure), out->lamp);
    out->lamp_distance = found_light_distance(code[MODEL_LIGHTS_DISTANCE]);
    for (int c = 0; c < 3; c++)
        out->lamp_strength[c] = kept ? model_decode_strength(code[MODEL_LIGHTS_STRENGTH + c]) : 0;
    model_decode_sh(code + MODEL_LIGHTS_REST, out->rest);
}

bool found_light_has_lamp(const float code[MODEL_LIGHTS])
{
    return vec3_length(vec3_of(code + MODEL_LIGHTS_LAMP)) >= LEAST_SURE;
}

float found_light_distance(float inverse)
{
    return inverse > 1 / FARTHEST ? 1 / inverse : 0;
}

found_light_shares found_light_share(const merlin_found_light *light)
{
    const float(*rest)[3] = (const float(*)[3])light->rest;
    found_light_shares share = {.flash = LIGHT_POWER * light->flash,
                                .lamp = LIGHT_POWER * found_light_mean(vec3_of(light->lamp_strength)),
                                .rest = fmaxf(found_light_mean(sh_irradiance(rest, vec3_make(0, 0, 1))), 0)};
    const float all = share.flash + share.lamp + share.rest;
    if (!light->known || !(all > 0)) return (found_light_shares){0};
    return (found_light_shares){share.flash / all, share.lamp / all, share.rest / all};
}

bool found_light_is_flash(const merlin_found_light *light)
{
    return found_light_share(light).flash >= FLASH_ALONE;
}

bool found_light_lamp(const merlin_found_light *light, lamp *out)
{
    const vec3 toward = vec3_of(light->lamp);
    if (!light->known || !(vec3_length(toward) > 0)) return false;
    const float far = light->lamp_distance;
    *out = far > 0 ? lamp_at(vec3_fma(object_middle, far, toward)) : lamp_toward(toward);
    /* the strength in the object's middle, whatever the distance */
    out->tint = vec3_scale(vec3_of(light->lamp_strength), far > 0 ? far * far : 1);
    return true;
}

/* ---- lights to relight by ---- */

enum { REST_WIDTH = 128, REST_HEIGHT = 64 };

/* Renders the radiance of the coefficients; returns its power in each channel, over all directions. The three bands of
 * a bright sky may be negative somewhere, which becomes black. */
static vec3 draw_rest(const merlin_found_light *light, img *out)
{
    vec3 power = {0, 0, 0};
    for (int i = 0; i < REST_WIDTH * REST_HEIGHT; i++) {
        real basis[9];
        const int x = i % REST_WIDTH, y = i / REST_WIDTH;
        float u = ((float)x + 0.5f) / REST_WIDTH, v = ((float)y + 0.5f) / REST_HEIGHT, *at = out->data + 3 * i;
        sh_basis(latlong_direction(u, v), basis);
        for (int c = 0; c < 3; c++) {
            float sum = 0;
            for (int k = 0; k < 9; k++)
                sum += basis[k] * light->rest[k][c];
            at[c] = fmaxf(sum, 0);
        }
        power = vec3_fma(power, latlong_solid_angle(y, REST_WIDTH, REST_HEIGHT), vec3_of(at));
    }
    return power;
}

/* Renders the rest as a picture of the power that its coefficients have, which black in place of what is negative would
 * add to. */
static status picture_of_rest(const merlin_found_light *light, img *out)
{
    status s = img_new(out, REST_WIDTH, REST_HEIGHT, 3);
    if (s != OK) return s;
    const vec3 power = draw_rest(light, out);
    const float drawn[3] = {power.x, power.y, power.z};
    for (int c = 0; c < 3; c++) {
        const float true_power = fmaxf(light->rest[0][c], 0) * 2 * sqrtf((float)PI);
        const float scale = drawn[c] > 0 ? true_power / drawn[c] : 0;
        for (int i = 0; i < REST_WIDTH * REST_HEIGHT; i++)
            out->data[3 * i + c] *= scale;
    }
    return OK;
}

static vec3 turned(vec3 d, float degrees)
{
    const float a = degrees * DEGREE, c = cosf(a), s = sinf(a);
    return vec3_make(c * d.x - s * d.z, d.y, s * d.x + c * d.z);
}

static status stand_rest(const merlin_found_light *light, env_map *out)
{
    img picture = {0};
    status s = picture_of_rest(light, &picture);
    float most = 0;
    for (size_t i = 0; s == OK && i < img_value_count(&picture); i++)
        most = fmaxf(most, picture.data[i]);
    if (s == OK && most > 0) s = env_map_new(&picture, out);
    img_free(&picture);
    return s;
}

status found_light_stand(const merlin_found_light *light, float turn, found_lights *out)
{
    *out = (found_lights){.count = 0};
    if (!light->known)
        return fail(MERLIN_BAD_INPUT,
                    "no light is known of these maps: they are a captured surface's, or a photograph's by a model that "
                    "knows one light alone: estimate it by merlin-any");
    if (light->flash > 0) {
        out->lamps[out->count] = lamp_at(vec3_make(0, 0, 0));
        out->lamps[out->count++].tint = vec3_make(light->flash, light->flash, light->flash);
    }
    out->fixed = out->count;
    if (found_light_lamp(light, &out->lamps[out->count])) out->count++;
    status s = stand_rest(light, &out->rest);
    if (s == OK && out->count == 0 && !found_lights_rest(out))
        s = fail(MERLIN_BAD_INPUT, "the light that was found in the photograph is dark");
    if (s == OK) found_lights_turn(out, turn);
    return s;
}

const env_map *found_lights_rest(const found_lights *l)
{
    return l->rest.levels[0].data ? &l->rest : NULL;
}

void found_lights_turn(found_lights *l, float degrees)
{
    for (int i = l->fixed; i < l->count; i++) {
        const vec3 about = l->lamps[i].distant ? vec3_make(0, 0, 0) : object_middle;
        l->lamps[i].at = vec3_add(about, turned(vec3_sub(l->lamps[i].at, about), degrees));
    }
    if (found_lights_rest(l)) env_map_turn(&l->rest, degrees);
}

/* ---- the photograph reconstructed ---- */

static void add_tinted(const img *from, vec3 tint, img *to)
{
    const float channel[3] = {tint.x, tint.y, tint.z};
    for (size_t i = 0; i < img_value_count(to); i++)
        to->data[i] += channel[i % 3] * from->data[i];
}

static status add_lamp(const surface *s, const lamp *l, const img *visibility, img *out)
{
    img lit = {0};
    status st = surface_shade_lamp(s, l, &lit);
    if (st == OK && visibility->data) shadow_darken(visibility, &lit);
    if (st == OK) add_tinted(&lit, l->tint, out);
    img_free(&lit);
    return st;
}

static status add_flash(const surface *s, float strength, img *out)
{
    img lit = {0};
    status st = surface_shade(s, vec3_make(0, 0, 0), &lit);
    if (st == OK) add_tinted(&lit, vec3_make(strength, strength, strength), out);
    img_free(&lit);
    return st;
}

status found_light_add(const surface *s, const merlin_found_light *light, const img *visibility, img *out)
{
    const float(*rest)[3] = (const float(*)[3])light->rest;
    lamp l;
    status st = light->flash > 0 ? add_flash(s, light->flash, out) : OK;
    if (st == OK && found_light_lamp(light, &l)) st = add_lamp(s, &l, visibility, out);
    if (st != OK) return st;
    surface_add_ambient(s, rest, out);
    surface_add_ambient_highlights(s, rest, out);
    return OK;
}
