/* SPDX-License-Identifier: MIT */
#include "nfps/nfps_inputs.h"

#include <math.h>
#include <string.h>

#include "base/number.h"
#include "model/nfps.h"
#include "nfps/nfps_matte.h"
#include "optics/led.h"

/* Limits: a light's strength relative to the mean, below which a picture says little and would be raised to noise; the
 * brightest highlight over the mean; a pixel's light over its root mean square in all pictures, and what is added to
 * the latter, as a share of the mean, lest noise in black be all that is seen. */
static const float FAINTEST = 0.03f, BRIGHTEST = 16, LARGEST_SHARE = 4, DARK = 0.02f;

vec3 nfps_light_at(const nfps_light *light, vec3 point, float *strength)
{
    *strength = 1;
    return light->distant ? light->at : led_light_at(light->at, light->axis, light->lobe, point, strength);
}

/* Rodrigues' formula for the axis k = view × z, of the length of the angle's sine. */
static vec3 rotate(vec3 k, float cosine, vec3 v)
{
    const vec3 once = vec3_cross(k, v);
    return vec3_add(v, vec3_fma(once, 1 / (1 + cosine), vec3_cross(k, once)));
}

vec3 nfps_turn(vec3 view, vec3 v)
{
    return rotate(vec3_make(view.y, -view.x, 0), view.z, v);
}

vec3 nfps_turn_back(vec3 view, vec3 v)
{
    return rotate(vec3_make(-view.y, view.x, 0), view.z, v);
}

void nfps_turn_all(const nfps_scene *scene, const float *normal, float *turned)
{
    for (size_t i = 0; i < 3 * scene->pixels; i += 3) {
        const bool inside = scene->mask[i / 3] > 0.5f;
        vec3_put(inside ? nfps_turn(vec3_of(scene->view + i), vec3_of(normal + i)) : (vec3){0}, turned + i);
    }
}

void nfps_turn_back_all(const nfps_scene *scene, const float *turned, float *normal)
{
    for (size_t i = 0; i < 3 * scene->pixels; i += 3) {
        const bool inside = scene->mask[i / 3] > 0.5f;
        vec3_put(inside ? nfps_turn_back(vec3_of(scene->view + i), vec3_of(turned + i)) : (vec3){0}, normal + i);
    }
}

static float sum3(const float *v)
{
    return v[0] + v[1] + v[2];
}

/* Writes directions to "light" and strengths to the workspace; returns the strengths' mean over the object. */
static float light_up(const nfps_scene *scene, float *strength, float *light)
{
    double sum = 0, count = 0;
    for (int k = 0; k < scene->pictures; k++, strength += scene->pixels, light += NFPS_LIGHT * scene->pixels)
        for (size_t i = 0; i < scene->pixels; i++) {
            if (!(scene->mask[i] > 0.5f)) continue;
            const vec3 toward = nfps_light_at(&scene->light[k], vec3_of(scene->point + 3 * i), &strength[i]);
            vec3_put(nfps_turn(vec3_of(scene->view + 3 * i), toward), light + NFPS_LIGHT * i);
            sum += (double)strength[i];
            count++;
        }
    return count > 0 ? (float)(sum / count) : 1;
}

/* Replaces strengths by those relative to the mean; returns the mean over pixels and pictures of the light divided by
 * them, all channels together. */
static float weigh(const nfps_scene *scene, const float *images, float mean, float *strength, float *light)
{
    double sum = 0, count = 0;
    for (int k = 0; k < scene->pictures; k++)
        for (size_t i = 0; i < scene->pixels; i++) {
            const size_t at = (size_t)k * scene->pixels + i;
            if (!(scene->mask[i] > 0.5f)) continue;
            const float relative = fmaxf(strength[at] / mean, FAINTEST);
            strength[at] = relative;
            light[NFPS_LIGHT * at + 3] = 0.5f * logf(relative);
            light[NFPS_LIGHT * at + 4] = scene->estimated ? 1 : 0;
            sum += (double)(sum3(images + 3 * at) / relative);
            count++;
        }
    return count > 0 ? fmaxf((float)(sum / count), 1e-12f) : 1;
}

/* Writes one pixel of all pictures; unit: the mean light, all channels together. */
static void encode_pixel(const nfps_scene *scene, const float *images, const float *strength, float unit, size_t i,
                         float *picture)
{
    double squares = 0;
    for (int k = 0; k < scene->pictures; k++) {
        const size_t at = (size_t)k * scene->pixels + i;
        const float sum = sum3(images + 3 * at) / (strength[at] * unit);
        squares += (double)sum * (double)sum;
    }
    const float scale = 1 / (sqrtf((float)squares / (float)scene->pictures) + DARK);
    for (int k = 0; k < scene->pictures; k++) {
        const size_t at = (size_t)k * scene->pixels + i;
        const float *from = images + 3 * at, divisor = 1 / (strength[at] * unit);
        float *to = picture + NFPS_PICTURE * at;
        for (int c = 0; c < 3; c++)
            to[c] = sqrtf(clamp(3 * from[c] * divisor, 0.0f, BRIGHTEST));
        to[3] = fminf(fmaxf(sum3(from), 0) * divisor * scale, LARGEST_SHARE);
    }
}

void nfps_encode(const nfps_scene *scene, const float *images, float *workspace, const nfps_arrays *out)
{
    const size_t all = (size_t)scene->pictures * scene->pixels;
    memset(out->picture, 0, NFPS_PICTURE * all * sizeof *out->picture);
    memset(out->light, 0, NFPS_LIGHT * all * sizeof *out->light);
    const float mean = light_up(scene, workspace, out->light), unit = weigh(scene, images, mean, workspace, out->light);
    for (size_t i = 0; i < scene->pixels; i++)
        if (scene->mask[i] > 0.5f) encode_pixel(scene, images, workspace, unit, i, out->picture);
    nfps_matte(scene, images, workspace, out->light, out->matte);
}
