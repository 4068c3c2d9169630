/* SPDX-License-Identifier: MIT */
#include "lab/render/sky.h"

#include <math.h>
#include <stdbool.h>

#include "base/number.h"
#include "lab/scene/shape/noise.h"
#include "optics/latlong.h"

static vec3 grey(float value)
{
    return vec3_make(value, value, value);
}

/* Returns a colour of this brightness, tinted between warm (-1) and cool (1). */
static vec3 tinted(float value, float coolness)
{
    return vec3_make(value * (1 - 0.35f * coolness), value, value * (1 + 0.45f * coolness));
}

static vec3 random_direction(rng *r, float lowest, float highest)
{
    float y = rng_range(r, lowest, highest), phi = rng_range(r, 0, 2 * PI), s = sqrtf(1 - y * y);
    return vec3_make(s * cosf(phi), y, s * sinf(phi));
}

/* ---- outdoors -------------------------------------------------------------------------------------------------- */

typedef struct outdoors {
    vec3 zenith, horizon, ground, cloud, sun, sun_direction;
    float sun_edge, sun_core, glow, cover, cloud_scale;
    uint32_t seed;
} outdoors;

static outdoors random_outdoors(rng *r)
{
    outdoors o;
    float coolness = rng_range(r, -0.2f, 1), height = rng_uniform(r);
    bool overcast = rng_uniform(r) < 0.3f;
    o.zenith = overcast ? grey(1) : tinted(0.6f, coolness);
    o.horizon = overcast ? grey(0.7f) : tinted(1, rng_range(r, -0.9f, 0.5f));
    float blue = rng_range(r, 0.4f, 0.9f), green = rng_range(r, 0.6f, 1), red = rng_range(r, 0.6f, 1);
    o.ground = vec3_scale(vec3_make(red, green, blue), rng_range(r, 0.1f, 0.5f));
    o.cloud = grey(rng_range(r, 0.9f, 1.8f));
    o.sun_direction = random_direction(r, 0.08f, 0.95f);
    /* between 3 and 6 degrees wide, far wider than the sun, so that a map of 256 texels can hold it */
    o.sun_core = cosf(rng_range(r, 0.025f, 0.05f));
    o.sun_edge = cosf(0.07f);
    o.sun = overcast ? grey(0) : tinted(rng_range(r, 60, 500), -0.8f * (1 - height));
    o.glow = overcast ? 0 : rng_range(r, 0.3f, 2);
    o.cover = overcast ? rng_range(r, 0.3f, 1) : rng_range(r, -0.2f, 0.8f);
    o.cloud_scale = rng_range(r, 0.7f, 2.5f);
    o.seed = rng_u32(r);
    return o;
}

static vec3 outdoors_at(const outdoors *o, vec3 d)
{
    if (d.y < 0) {
        vec3 p = vec3_scale(d, 1.5f / (0.15f - d.y));
        return vec3_scale(o->ground, 1 + 0.6f * noise_fbm(p, 3, o->seed));
    }
    vec3 sky = vec3_lerp(o->horizon, o->zenith, sqrtf(d.y));
    vec3 p = vec3_scale(d, o->cloud_scale / (d.y + 0.2f));
    float cloud = smooth_step(-0.2f, 0.5f, noise_fbm(p, 4, o->seed) + o->cover - 0.5f);
    sky = vec3_lerp(sky, o->cloud, 0.8f * cloud);
    float toward = vec3_dot(d, o->sun_direction);
    sky = vec3_add(sky, grey(o->glow * expf(12 * (toward - 1))));
    return vec3_fma(sky, smooth_step(o->sun_edge, o->sun_core, toward) * (1 - 0.9f * cloud), o->sun);
}

/* ---- a room ---------------------------------------------------------------------------------------------------- */

enum { ROOM_LAMPS = 4 };

typedef struct sky_lamp {
    int wall;                  /* 0..5: -x, +x, floor, ceiling, -z, +z */
    float x, y, width, height; /* rectangle on the wall, in the wall's half sizes */
    vec3 radiance;
} sky_lamp;

typedef struct room {
    float half[3], eye[3];
    vec3 wall[6];
    sky_lamp lamps[ROOM_LAMPS];
    int lamp_count;
    uint32_t seed;
} room;

static room random_room(rng *r)
{
    room o;
    for (int i = 0; i < 3; i++) {
        o.half[i] = rng_range(r, 1.2f, 4);
        o.eye[i] = o.half[i] * rng_range(r, -0.5f, 0.5f);
    }
    float coolness = rng_range(r, -0.8f, 0.4f);
    vec3 paint = tinted(rng_range(r, 0.3f, 0.8f), coolness);
    for (int i = 0; i < 6; i++)
        o.wall[i] = vec3_scale(paint, rng_range(r, 0.7f, 1.1f));
    coolness = rng_range(r, -1, 0);
    o.wall[2] = tinted(rng_range(r, 0.1f, 0.4f), coolness);
    o.wall[3] = grey(rng_range(r, 0.6f, 0.9f));
    o.lamp_count = 1 + rng_below(r, ROOM_LAMPS);
    for (int i = 0; i < o.lamp_count; i++) {
        static const int places[] = {0, 1, 3, 3, 4, 5};
        sky_lamp *l = &o.lamps[i];
        l->wall = places[rng_below(r, 6)];
        l->width = rng_range(r, 0.1f, 0.45f);
        l->height = rng_range(r, 0.1f, 0.45f);
        l->x = rng_range(r, -0.6f, 0.6f);
        l->y = rng_range(r, -0.2f, 0.5f);
        coolness = l->wall == 3 ? rng_range(r, -0.8f, 0.1f) : rng_range(r, -0.2f, 0.8f);
        l->radiance = tinted(rng_range(r, 6, 40), coolness);
    }
    o.seed = rng_u32(r);
    return o;
}

static vec3 room_at(const room *o, vec3 d)
{
    float direction[3] = {d.x, d.y, d.z}, nearest = 1e9f;
    int axis = 0;
    for (int i = 0; i < 3; i++) {
        float t = (copysignf(o->half[i], direction[i]) - o->eye[i]) /
                  copysignf(fmaxf(fabsf(direction[i]), 1e-6f), direction[i]);
        if (t < nearest) {
            nearest = t;
            axis = i;
        }
    }
    int wall = 2 * axis + (direction[axis] > 0), across = axis == 0 ? 2 : 0, up = axis == 1 ? 2 : 1;
    float x = (o->eye[across] + nearest * direction[across]) / o->half[across];
    float y = (o->eye[up] + nearest * direction[up]) / o->half[up];
    for (int i = 0; i < o->lamp_count; i++) {
        const sky_lamp *l = &o->lamps[i];
        if (l->wall == wall && fabsf(x - l->x) < l->width && fabsf(y - l->y) < l->height) return l->radiance;
    }
    /* corners are darker, as are the places of furniture */
    float shade = (1 - 0.35f * x * x) * (1 - 0.35f * y * y);
    vec3 p = {3 * x, 3 * y, (float)wall};
    if (axis != 1 && y < 0.1f + 0.5f * noise_gradient(p, o->seed))
        shade *= 0.5f + 0.4f * noise_gradient(vec3_scale(p, 2), o->seed);
    return vec3_scale(o->wall[wall], 0.6f * fmaxf(shade, 0.05f));
}

/* ---- a studio -------------------------------------------------------------------------------------------------- */

enum { STUDIO_BOXES = 5 };

typedef struct studio {
    vec3 direction[STUDIO_BOXES], right[STUDIO_BOXES], above[STUDIO_BOXES], radiance[STUDIO_BOXES];
    float width[STUDIO_BOXES], height[STUDIO_BOXES];
    int count;
    float floor, backdrop;
} studio;

static studio random_studio(rng *r)
{
    studio o;
    o.count = 2 + rng_below(r, STUDIO_BOXES - 1);
    o.floor = rng_range(r, 0.03f, 0.5f);
    o.backdrop = rng_range(r, 0.02f, 0.35f);
    for (int i = 0; i < o.count; i++) {
        o.direction[i] = random_direction(r, -0.1f, 0.95f);
        o.right[i] = vec3_normalize(vec3_cross(o.direction[i], vec3_make(0, 1, 0)));
        o.above[i] = vec3_cross(o.right[i], o.direction[i]);
        o.width[i] = rng_range(r, 0.08f, 0.6f);
        o.height[i] = rng_range(r, 0.08f, 0.6f);
        float coolness = rng_range(r, -0.6f, 0.5f);
        o.radiance[i] = tinted(rng_range(r, 3, 40), coolness);
    }
    return o;
}

static vec3 studio_at(const studio *o, vec3 d)
{
    vec3 sum = grey(d.y < 0 ? o->floor * (1 + 0.5f * d.y) : o->backdrop * (1 + 0.5f * d.y));
    for (int i = 0; i < o->count; i++) {
        float toward = vec3_dot(d, o->direction[i]);
        if (toward <= 0.1f) continue;
        float x = fabsf(vec3_dot(d, o->right[i])) / toward, y = fabsf(vec3_dot(d, o->above[i])) / toward;
        float inside =
            smooth_step(o->width[i], 0.85f * o->width[i], x) * smooth_step(o->height[i], 0.85f * o->height[i], y);
        sum = vec3_fma(sum, inside, o->radiance[i]);
    }
    return sum;
}

void sky_fill(img *map, rng *r)
{
    float kind = rng_uniform(r);
    outdoors out = random_outdoors(r);
    room in = random_room(r);
    studio lit = random_studio(r);
    for (int y = 0; y < map->height; y++)
        for (int x = 0; x < map->width; x++) {
            vec3 d = latlong_direction(((float)x + 0.5f) / (float)map->width, ((float)y + 0.5f) / (float)map->height);
            vec3 c = kind < 0.45f ? outdoors_at(&out, d) : kind < 0.8f ? room_at(&in, d) : studio_at(&lit, d);
            float *texel = img_at(map, x, y);
            texel[0] = fmaxf(0, c.x);
            texel[1] = fmaxf(0, c.y);
            texel[2] = fmaxf(0, c.z);
        }
}
