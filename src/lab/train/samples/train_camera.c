/* SPDX-License-Identifier: MIT */
#include "lab/train/samples/train_camera.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/number.h"
#include "image/color.h"
#include "model/model.h"

/* Natural logarithm of the highest radiance at which a sensor saturates. */
static const float WHITE_RANGE = 0.9f;

train_camera train_camera_perfect(void)
{
    return (train_camera){.gain = {1, 1, 1}, .white = 1, .gamma = 1};
}

train_camera train_camera_draw(const train_config *c, rng *r)
{
    train_camera lens = train_camera_perfect();
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

/* Chooses a background: farther from the flash than the object, so that it is mostly dark, but it may be a white sheet.
 */
static void draw_background(rng *r, train_camera *lens)
{
    enum { ENDS = 2 };
    for (int e = 0; e < ENDS; e++) {
        float light = expf(rng_range(r, -4, 0.2f));
        for (int c = 0; c < 3; c++)
            lens->behind[e][c] = light * rng_range(r, 0.5f, 1);
    }
    float angle = 2 * PI * rng_uniform(r);
    lens->across[0] = cosf(angle);
    lens->across[1] = sinf(angle);
}

void train_camera_degrade(const train_config *c, rng *r, train_camera *lens)
{
    lens->background = rng_uniform(r) < (float)c->background_leak;
    if (lens->background) draw_background(r, lens);
    bool wrong = rng_uniform(r) < (float)c->outline_error, larger = rng_uniform(r) < 0.5f;
    lens->outline = wrong ? (larger ? 1 : -1) : 0;
    lens->jpeg = rng_uniform(r) < (float)c->jpeg;
    /* no very low qualities: a photograph that was shrunk has lost most of its compression artefacts */
    lens->jpeg_settings.quality = 50 + rng_below(r, 46);
    lens->jpeg_settings.halved = rng_uniform(r) < 0.7f;
    if (rng_uniform(r) < (float)c->perfect_camera) *lens = train_camera_perfect();
}

/* Returns an approximately normal number, mean 0, variance 1: the sum of a random number's four bytes. */
static float cheap_normal(rng *r)
{
    uint32_t u = rng_u32(r);
    int sum = (int)(u & 255) + (int)(u >> 8 & 255) + (int)(u >> 16 & 255) + (int)(u >> 24);
    return ((float)sum - 510.0f) * (1.0f / 147.8f); /* variance of four bytes: 4 (256² - 1)/12 */
}

/* Applies the camera's tone curve to an sRGB code: a power, and a sigmoid with a toe and a shoulder as of film. */
static float toned(const train_camera *lens, float code)
{
    float y = powf(code, lens->gamma);
    return y + lens->contrast * y * (1 - y) * (2 * y - 1);
}

static float photographed(const train_camera *lens, float radiance, int channel, rng *noise)
{
    float x = fminf(radiance * lens->gain[channel] / lens->white, 1.0f);
    if (lens->read > 0 || lens->shot > 0) x += sqrtf(lens->shot * x + lens->read * lens->read) * cheap_normal(noise);
    x = clamp(x, 0.0f, 1.0f);
    if (lens->gamma != 1 || lens->contrast != 0) x = srgb_decode(toned(lens, srgb_encode(x)));
    if (lens->eight_bit) x = srgb_decode(roundf(srgb_encode(x) * 255.0f) / 255.0f);
    return x * lens->white;
}

static float background_at(const train_camera *lens, int size, size_t pixel, int channel)
{
    int x = (int)(pixel % (size_t)size), y = (int)(pixel / (size_t)size);
    float right = (float)x / (float)size - 0.5f, down = (float)y / (float)size - 0.5f;
    float t = 0.5f + right * lens->across[0] + down * lens->across[1];
    t = clamp(t, 0, 1);
    return (1 - t) * lens->behind[0][channel] + t * lens->behind[1][channel];
}

/* Returns the factor of vignetting at a pixel: cos⁴ for a wide lens, weaker for others. */
static float vignette_at(const train_camera *lens, int size, size_t pixel)
{
    if (lens->vignette == 0) return 1;
    int x = (int)(pixel % (size_t)size), y = (int)(pixel / (size_t)size);
    float half = 0.5f * (float)size, right = ((float)x + 0.5f) / half - 1, down = ((float)y + 0.5f) / half - 1;
    return 1 - lens->vignette * 0.5f * (right * right + down * down);
}

/* Returns the radiance of an object's pixel. */
static float radiance_of(const train_view *v, bool global, size_t value)
{
    if (v->photo) return v->photo[value];
    float radiance = v->direct[value] + (global ? v->indirect[value] : 0.0f);
    return v->env ? radiance + v->env[value] : radiance;
}

/* Simulates the sensor, for the object's pixels or the whole frame. */
static void expose(const train_view *v, bool global, const train_camera *lens, bool whole, rng *noise)
{
    size_t pixels = (size_t)v->size * (size_t)v->size;
    memset(v->image, 0, 3 * pixels * sizeof(float));
    for (size_t i = 0; i < pixels; i++) {
        if (!whole && v->mask[i] <= 0.5f) continue;
        const float let_through = vignette_at(lens, v->size, i);
        for (int c = 0; c < 3; c++) {
            float radiance = let_through * radiance_of(v, global, 3 * i + (size_t)c);
            if (lens->background) radiance += (1 - v->mask[i]) * background_at(lens, v->size, i, c);
            v->image[3 * i + (size_t)c] = photographed(lens, radiance, c, noise);
        }
    }
}

static status compress(const train_view *v, const train_camera *lens)
{
    size_t values = 3 * (size_t)v->size * (size_t)v->size;
    uint8_t *rgb = malloc(values);
    if (!rgb) return fail(MERLIN_NO_MEMORY, "out of memory for a photograph of %d pixels' width", v->size);
    for (size_t i = 0; i < values; i++)
        rgb[i] = (uint8_t)(srgb_encode(v->image[i] / lens->white) * 255 + 0.5f);
    status s = img_jpeg_round_trip(rgb, v->size, v->size, &lens->jpeg_settings);
    float decoded[256];
    for (int i = 0; i < 256; i++)
        decoded[i] = srgb_decode((float)i / 255) * lens->white;
    for (size_t i = 0; i < values && s == OK; i++)
        v->image[i] = decoded[rgb[i]];
    free(rgb);
    return s;
}

/* Tells whether a pixel is inside the mask as cut out: the true mask, dilated or eroded by a pixel. */
static bool is_seen(const train_view *v, int outline, int x, int y)
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

status train_photograph(const train_view *v, bool global, const train_camera *lens, rng *noise)
{
    /* a dilated mask shows pixels that the object covers by less than half */
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

void train_camera_add_response(rng *r, train_camera *lens)
{
    bool own_curve = rng_uniform(r) < 0.5f, falls_off = rng_uniform(r) < 0.3f;
    float gamma = expf(rng_range(r, -0.25f, 0.25f)), contrast = rng_range(r, -0.4f, 0.8f);
    float vignette = rng_range(r, 0.05f, 0.4f);
    if (own_curve) {
        lens->gamma = gamma;
        lens->contrast = contrast;
    }
    lens->vignette = falls_off ? vignette : 0;
}
