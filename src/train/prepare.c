#include "train/prepare.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "image/write.h"
#include "optics/ambient.h"
#include "optics/camera.h"
#include "optics/light.h"

/* Natural logarithm of the highest radiance a sensor takes without saturating. */
static const float WHITE_RANGE = 0.9f;

trn_camera trn_camera_perfect(void)
{
    return (trn_camera){.gain = {1, 1, 1}, .white = 1};
}

trn_camera trn_camera_draw(const train_config *c, rng *r)
{
    trn_camera lens = trn_camera_perfect();
    float exposure = (float)c->exposure_jitter * rng_range(r, -1, 1);
    for (int k = 0; k < 3; k++)
        lens.gain[k] = expf(exposure + (float)c->colour_jitter * rng_range(r, -1, 1));
    bool noisy = rng_uniform(r) < 0.5f;
    lens.shot = rng_uniform(r) * (noisy ? 2e-4f : 0.0f);
    lens.read = rng_uniform(r) * (noisy ? 5e-3f : 0.0f);
    lens.eight_bit = rng_uniform(r) < 0.5f;
    lens.white = expf(WHITE_RANGE * rng_uniform(r));
    return lens;
}

/* Backgrounds are farther from the flash than the object and mostly dark in its light, but a white sheet is not. */
static void draw_background(rng *r, trn_camera *lens)
{
    enum { ENDS = 2 };
    for (int e = 0; e < ENDS; e++) {
        float light = expf(rng_range(r, -4, 0.2f));
        for (int c = 0; c < 3; c++)
            lens->behind[e][c] = light * rng_range(r, 0.5f, 1);
    }
    float angle = 6.2831853f * rng_uniform(r);
    lens->across[0] = cosf(angle);
    lens->across[1] = sinf(angle);
}

void trn_camera_spoil(const train_config *c, rng *r, trn_camera *lens)
{
    lens->background = rng_uniform(r) < (float)c->background_leak;
    if (lens->background) draw_background(r, lens);
    bool wrong = rng_uniform(r) < (float)c->outline_error, larger = rng_uniform(r) < 0.5f;
    lens->outline = wrong ? (larger ? 1 : -1) : 0;
    lens->jpeg = rng_uniform(r) < (float)c->jpeg;
    /* a photograph that was made smaller has lost most of what compression did to it: no very low qualities */
    lens->jpeg_settings.quality = 50 + rng_below(r, 46);
    lens->jpeg_settings.halved = rng_uniform(r) < 0.7f;
    if (rng_uniform(r) < (float)c->perfect_camera) *lens = trn_camera_perfect();
}

vec3 trn_draw_light(rng *r)
{
    float u1 = rng_uniform(r), u2 = rng_uniform(r);
    return frontal_light(u1, u2);
}

/* Nearly normal, mean 0, variance 1, from one draw: the sum of its four bytes. */
static float cheap_normal(rng *r)
{
    uint32_t u = rng_u32(r);
    int sum = (int)(u & 255) + (int)(u >> 8 & 255) + (int)(u >> 16 & 255) + (int)(u >> 24);
    return ((float)sum - 510.0f) * (1.0f / 147.8f); /* variance of four bytes: 4 (256² - 1)/12 */
}

static float photographed(const trn_camera *lens, float radiance, int channel, rng *noise)
{
    float x = fminf(radiance * lens->gain[channel] / lens->white, 1.0f);
    if (lens->read > 0 || lens->shot > 0) x += sqrtf(lens->shot * x + lens->read * lens->read) * cheap_normal(noise);
    x = fminf(fmaxf(x, 0.0f), 1.0f);
    if (lens->eight_bit) x = srgb_decode(roundf(srgb_encode(x) * 255.0f) / 255.0f);
    return x * lens->white;
}

float trn_draw_strength(rng *r)
{
    return expf(rng_range(r, logf(0.1f), 0));
}

float trn_draw_target_strength(float dark_share, rng *r)
{
    float strength = trn_draw_strength(r);
    return rng_uniform(r) < dark_share ? 0 : strength;
}

static float background_at(const trn_camera *lens, int size, size_t pixel, int channel)
{
    int x = (int)(pixel % (size_t)size), y = (int)(pixel / (size_t)size);
    float right = (float)x / (float)size - 0.5f, down = (float)y / (float)size - 0.5f;
    float t = 0.5f + right * lens->across[0] + down * lens->across[1];
    t = fminf(fmaxf(t, 0), 1);
    return (1 - t) * lens->behind[0][channel] + t * lens->behind[1][channel];
}

/* What the sensor sees, of the object's pixels or of the whole frame. */
static void expose(const trn_view *v, bool global, const trn_camera *lens, bool whole, rng *noise)
{
    size_t pixels = (size_t)v->size * (size_t)v->size;
    memset(v->image, 0, 3 * pixels * sizeof(float));
    for (size_t i = 0; i < pixels; i++) {
        if (!whole && v->mask[i] <= 0.5f) continue;
        for (int c = 0; c < 3; c++) {
            float radiance = v->direct[3 * i + (size_t)c] + (global ? v->indirect[3 * i + (size_t)c] : 0.0f);
            if (v->env) radiance += v->env[3 * i + (size_t)c];
            if (lens->background) radiance += (1 - v->mask[i]) * background_at(lens, v->size, i, c);
            v->image[3 * i + (size_t)c] = photographed(lens, radiance, c, noise);
        }
    }
}

static status compress(const trn_view *v, const trn_camera *lens)
{
    size_t values = 3 * (size_t)v->size * (size_t)v->size;
    uint8_t *rgb = malloc(values);
    if (!rgb) return fail(ERROR_MEMORY, "out of memory for a photograph of %d pixels' width", v->size);
    for (size_t i = 0; i < values; i++)
        rgb[i] = (uint8_t)(srgb_encode(v->image[i] / lens->white) * 255 + 0.5f);
    status s = img_jpeg_spoil(rgb, v->size, v->size, &lens->jpeg_settings);
    float decoded[256];
    for (int i = 0; i < 256; i++)
        decoded[i] = srgb_decode((float)i / 255) * lens->white;
    for (size_t i = 0; i < values && s == OK; i++)
        v->image[i] = decoded[rgb[i]];
    free(rgb);
    return s;
}

/* Where whoever cut the object out saw it: the true mask, or a pixel more or less of it. */
static bool is_seen(const trn_view *v, int outline, int x, int y)
{
    static const int beside[5][2] = {{0, 0}, {-1, 0}, {1, 0}, {0, -1}, {0, 1}};
    bool larger = outline > 0;
    for (int k = 0; k < (outline ? 5 : 1); k++) {
        int i = x + beside[k][0], j = y + beside[k][1];
        bool in_frame = i >= 0 && j >= 0 && i < v->size && j < v->size;
        bool object = in_frame && v->mask[(size_t)j * (size_t)v->size + (size_t)i] > 0.5f;
        if (object == larger && (k == 0 || in_frame)) return larger;
    }
    return !larger;
}

/* The input, encoded, and where it shows something in loss_mask. */
static status take_photograph(const trn_view *v, bool global, const trn_camera *lens, rng *noise)
{
    /* a mask too large shows pixels that the object covers by less than half */
    expose(v, global, lens, lens->background || lens->jpeg || lens->outline > 0, noise);
    status s = lens->jpeg ? compress(v, lens) : OK;
    for (int y = 0; y < v->size; y++) {
        for (int x = 0; x < v->size; x++) {
            size_t i = (size_t)y * (size_t)v->size + (size_t)x;
            v->loss_mask[i] = is_seen(v, lens->outline, x, y);
            if (v->loss_mask[i] > 0)
                model_encode_image(v->image + 3 * i, v->image + 3 * i, 3);
            else
                memset(v->image + 3 * i, 0, 3 * sizeof(float));
        }
    }
    return s;
}

void trn_render(const trn_view *maps, vec3 light, float *out)
{
    int size = maps->size;
    camera c = {.width = size, .height = size, .fov = MODEL_FOV};
    float pixel = camera_pixel_size(&c), half = 0.5f * (float)size;
    memset(out, 0, 3 * (size_t)size * (size_t)size * sizeof(float));
    for (int y = 0; y < size; y++) {
        for (int x = 0; x < size; x++) {
            size_t i = (size_t)y * (size_t)size + (size_t)x;
            if (maps->mask[i] <= 0.5f) continue;
            shade_input in = {.albedo = vec3_of(maps->albedo + 3 * i),
                              .roughness = maps->roughness[i],
                              .normal = vec3_of(maps->normal + 3 * i),
                              .depth = maps->depth[i],
                              .ray = {((float)x + 0.5f - half) * pixel, (half - (float)y - 0.5f) * pixel, -1},
                              .light = light,
                              .power = MODEL_LIGHT_POWER};
            vec3 radiance = shade_point(&in);
            out[3 * i] = fminf(radiance.x, 1.0f);
            out[3 * i + 1] = fminf(radiance.y, 1.0f);
            out[3 * i + 2] = fminf(radiance.z, 1.0f);
        }
    }
}

static void add3(float *to, size_t i, vec3 v)
{
    to[3 * i] += v.x;
    to[3 * i + 1] += v.y;
    to[3 * i + 2] += v.z;
}

void trn_add_environment(const trn_view *maps, const float sh[9][3], float *image)
{
    size_t pixels = (size_t)maps->size * (size_t)maps->size;
    for (size_t i = 0; i < pixels; i++) {
        if (maps->mask[i] <= 0) continue;
        vec3 white = vec3_scale(sh_irradiance(sh, vec3_of(maps->normal + 3 * i)), maps->mask[i] / BRDF_PI);
        add3(image, i, vec3_mul(white, vec3_of(maps->albedo + 3 * i)));
    }
}

/* image -= what the specular lobe reflects of the environment, times coverage. */
static void subtract_highlights(const trn_view *maps, const float sh[9][3], float *image)
{
    int size = maps->size;
    camera c = {.width = size, .height = size, .fov = MODEL_FOV};
    for (int y = 0; y < size; y++) {
        for (int x = 0; x < size; x++) {
            size_t i = (size_t)y * (size_t)size + (size_t)x;
            if (maps->mask[i] <= 0) continue;
            vec3 view = vec3_scale(camera_ray(&c, (float)x + 0.5f, (float)y + 0.5f), -1);
            vec3 reflected = ambient_specular(sh, maps->roughness[i], vec3_of(maps->normal + 3 * i), view);
            add3(image, i, vec3_scale(reflected, -maps->mask[i]));
        }
    }
}

/* Environment image and coefficients at the strength of this presentation. */
static void scale_environment(const trn_view *v, float strength)
{
    size_t values = 3 * (size_t)v->size * (size_t)v->size;
    for (size_t i = 0; i < values; i++)
        v->env[i] *= strength;
    for (int i = 0; i < MODEL_SH; i++)
        v->sh[i] *= strength;
}

/* Direct gains what the rendering layer makes of the environment, indirect what that lacks of the truth. Shadows do not
 * take more than there was, and light of later bounces does not exceed the first's: what does is a highlight that is
 * not as the coefficients say. */
static void add_environment(const trn_view *v, const float sh[9][3])
{
    size_t values = 3 * (size_t)v->size * (size_t)v->size;
    float *rest = v->env, *shaded = v->reconstruction; /* which is filled later */
    memset(shaded, 0, values * sizeof *shaded);
    trn_add_environment(v, sh, shaded);
    subtract_highlights(v, sh, rest);
    for (size_t i = 0; i < values; i++) {
        v->direct[i] += shaded[i];
        v->indirect[i] += fminf(fmaxf(rest[i], 0) - shaded[i], fmaxf(shaded[i], 0));
    }
}

/* The target under both lights, clipped as the rendering layer clips. */
static void add_target_environment(const trn_view *v, const float sh[9][3])
{
    size_t values = 3 * (size_t)v->size * (size_t)v->size;
    trn_add_environment(v, sh, v->relit);
    for (size_t i = 0; i < values; i++)
        v->relit[i] = v->mask[i / 3] > 0.5f ? fminf(fmaxf(v->relit[i], 0.0f), 1.0f) : 0.0f;
    model_encode_sh(sh, v->target_sh);
}

/* Masks become binary, maps go to the network's ranges. */
static void convert(const trn_view *v)
{
    size_t pixels = (size_t)v->size * (size_t)v->size;
    for (size_t i = 0; i < pixels; i++) {
        float seen = v->loss_mask[i];
        v->loss_mask[i] = v->mask[i] >= 0.999f ? seen : 0.0f; /* coverage was rounded to half */
        v->mask[i] = seen;
        v->roughness[i] = 2 * v->roughness[i] - 1;
    }
    for (size_t i = 0; i < 3 * pixels; i++) {
        v->reconstruction[i] = v->direct[i] + v->indirect[i];
        v->albedo[i] = 2 * v->albedo[i] - 1;
    }
}

status trn_prepare(const trn_view *v, bool global, const trn_camera *lens, const trn_lighting *lighting, rng *noise)
{
    size_t values = 3 * (size_t)v->size * (size_t)v->size;
    vec3 light = lighting->target;
    if (v->env) scale_environment(v, lighting->strength);
    status s = take_photograph(v, global, lens, noise);
    if (s != OK) return s;
    trn_render(v, light, v->relit);
    for (size_t i = 0; i < values; i++)
        v->direct[i] = fminf(v->direct[i], 1.0f);
    if (v->env) {
        float sh[9][3];
        memcpy(sh, v->sh, sizeof sh);
        add_environment(v, (const float(*)[3])sh);
        model_encode_sh((const float(*)[3])sh, v->sh);
        add_target_environment(v, lighting->target_sh);
    }
    convert(v);
    vec3_put(light, v->light);
    return OK;
}
