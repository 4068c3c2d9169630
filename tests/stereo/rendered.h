/* Captures rendered by ray tracing, with true normals: cast shadows always, light between surfaces if asked for.
 *
 *     rendered how = {.size = 64, .lights = 50, .roughness = 0.3f, .exposure = 1};
 *     pst_capture c;
 *     rendered_capture(&how, &object, &c);
 *
 * Distant lights shine with radiance 1 a steradian; near lights are LEDs about the camera, or bare bulbs on the frontal
 * hemisphere. */
#ifndef MERLIN_TESTS_STEREO_RENDERED_H
#define MERLIN_TESTS_STEREO_RENDERED_H

#include "optics/camera.h"
#include "relief.h"
#include "render/paths.h"
#include "scene/material.h"

typedef struct rendered {
    int size, lights, strata, paths; /* strata² points a pixel; paths: of indirect light a pixel, 0 for none */
    float fov;                       /* degrees; 0: orthographic */
    float roughness;                 /* 0: the material's own */
    float paleness;                  /* factor on the material's albedo; 0: 1 */
    float phong, exponent;           /* a lobe phong · (n·h)^exponent instead of the microfacets', if above 0 */
    float exposure;
    bool grey, leds, bulbs, eight_bit;
} rendered;

typedef struct rendering {
    const rendered *how;
    trace_scene scene;
    pst_capture *capture;
    rng random;
    sequence spread;
    uint32_t next; /* path of the sequence */
} rendering;

/* Two rings and a few between: what capture domes have. */
static inline vec3 rendered_light(int i, int count)
{
    int inner = count / 3;
    float phi =
        6.2831853f * (i < inner ? (float)i / (float)inner : ((float)(i - inner) + 0.5f) / (float)(count - inner));
    float tilt = i < inner ? 0.35f : 0.75f + 0.25f * (float)(i % 3);
    return vec3_make(sinf(tilt) * cosf(phi), sinf(tilt) * sinf(phi), cosf(tilt));
}

/* Rings of LEDs about the camera that look at the object, one to two of its sizes away. */
static inline void rendered_led(int i, int count, pst_light *led)
{
    float phi = 6.2831853f * (float)i / (float)count * 2, ring = i % 2 ? 0.3f : 0.65f;
    led->position = vec3_make(ring * cosf(phi), ring * sinf(phi), i % 2 ? -0.05f : -0.3f);
    led->direction = vec3_normalize(vec3_sub(vec3_make(0, 0, -1), led->position));
    led->lobe = 1.5f;
}

/* On a spiral over the half of the sphere of radius 1 about (0, 0, -1) that faces the camera. */
static inline vec3 rendered_bulb(int i, int count)
{
    float z = ((float)i + 0.5f) / (float)count, across = sqrtf(1 - z * z), phi = 2.3999632f * (float)i;
    return vec3_make(across * cosf(phi), across * sinf(phi), z - 1);
}

static inline vec3 rendered_shade(const rendering *r, const scn_surface *at, vec3 view, vec3 l)
{
    const rendered *how = r->how;
    vec3 f = how->phong > 0 ? vec3_scale(at->albedo, 1 / BRDF_PI)
                            : brdf_eval(at->albedo, at->roughness, at->normal, l, view);
    float n_l = vec3_dot(at->normal, l);
    if (how->phong > 0) {
        float lobe = how->phong * powf(fmaxf(vec3_dot(at->normal, brdf_half_vector(l, view)), 0), how->exponent);
        f = vec3_add(f, vec3_make(lobe, lobe, lobe));
    }
    return vec3_scale(f, n_l);
}

/* Radiance by one light, straight and by way of other surfaces. */
static inline vec3 rendered_radiance(rendering *r, const scn_surface *at, vec3 view, const pst_light *from)
{
    bool led = r->how->leds || r->how->bulbs;
    static const float far = 500;
    vec3 position = led ? from->position : vec3_scale(from->direction, far), sum = {0, 0, 0};
    vec3 to = vec3_sub(position, at->position), l = led ? vec3_normalize(to) : from->direction;
    float power = led ? 1 / vec3_dot(to, to) : 1;
    vec3 origin = trace_leave(at);
    if (vec3_dot(at->normal, l) > 0 && vec3_dot(at->geometric_normal, l) > 0 &&
        !trace_occluded(&r->scene, origin, l, vec3_length(to)))
        sum = vec3_scale(rendered_shade(r, at, view, l), power);
    if (r->how->paths > 0) {
        point_light source = {.position = position, .power = led ? 1 : far * far};
        path_points point = {at, &view, 1, r->next++};
        path_source drawn = {&r->spread, &r->random};
        vec3 bounce[1][2];
        point_light_paths(&r->scene, &point, 1, &source, &drawn, 1, bounce);
        sum = vec3_add(sum, vec3_add(bounce[0][0], bounce[0][1]));
    }
    /* the lobe is applied to all that the LED sends, as seen from the surface */
    return r->how->leds ? vec3_scale(sum, powf(fmaxf(-vec3_dot(l, from->direction), 0), from->lobe)) : sum;
}

static inline uint16_t rendered_code(const rendered *how, float radiance)
{
    float v = fminf(how->exposure * radiance, 1);
    return how->eight_bit ? (uint16_t)(roundf(v * 255) * 257) : relief_code(v);
}

static inline bool rendered_ray(const rendered *how, float x, float y, vec3 *origin, vec3 *direction)
{
    camera eye = {how->size, how->size, how->fov};
    float pixel = 1.1f / (float)how->size, middle = 0.5f * (float)how->size;
    *origin = how->fov > 0 ? vec3_make(0, 0, 0) : vec3_make((x - middle) * pixel, (middle - y) * pixel, 0);
    *direction = how->fov > 0 ? camera_ray(&eye, x, y) : vec3_make(0, 0, -1);
    return true;
}

/* Pixels whose points all lie on the object belong to the mask. */
static inline void rendered_pixel(rendering *r, int i, int j)
{
    const rendered *how = r->how;
    pst_capture *c = r->capture;
    int strata = how->strata > 0 ? how->strata : 1, points = strata * strata, channels = c->channels;
    scn_surface at[16];
    vec3 view[16], normal = {0, 0, 0};
    float depth = 0;
    for (int s = 0; s < points; s++) {
        vec3 origin, direction;
        rendered_ray(how, (float)i + ((float)(s % strata) + 0.5f) / (float)strata,
                     (float)j + ((float)(s / strata) + 0.5f) / (float)strata, &origin, &direction);
        if (!trace_surface(&r->scene, origin, direction, &at[s])) return;
        view[s] = vec3_scale(direction, -1);
        normal = vec3_add(normal, at[s].normal);
        depth -= at[s].position.z / (float)points;
        if (how->roughness > 0) at[s].roughness = how->roughness;
        if (how->paleness > 0) at[s].albedo = vec3_scale(at[s].albedo, how->paleness);
        if (how->grey) at[s].albedo = vec3_make(at[s].albedo.y, at[s].albedo.y, at[s].albedo.y);
    }
    normal = vec3_normalize(normal);
    if (normal.z < 0.05f) return;
    size_t pixel = (size_t)j * (size_t)how->size + (size_t)i;
    c->mask.data[pixel] = 1;
    c->depth_true.data[pixel] = depth;
    memcpy(c->normal_true.data + 3 * pixel, &(float[3]){normal.x, normal.y, normal.z}, 3 * sizeof(float));
    int paths = how->paths > points ? how->paths : points;
    for (int k = 0; k < how->lights; k++) {
        vec3 sum = {0, 0, 0};
        for (int s = 0; s < paths; s++)
            sum = vec3_add(sum, rendered_radiance(r, &at[s % points], view[s % points], &c->light[k]));
        sum = vec3_scale(sum, 1 / (float)paths);
        float rgb[3] = {sum.x, sum.y, sum.z};
        for (int ch = 0; ch < channels; ch++)
            c->picture[k][pixel * (size_t)channels + (size_t)ch] = rendered_code(how, rgb[ch]);
    }
}

static inline void rendered_capture(const rendered *how, const scn_object *object, pst_capture *c)
{
    trace_device *device;
    rendering r = {.how = how, .capture = c, .random = rng_at(1, 2, 3)};
    r.spread = sequence_of(&r.random);
    capture_new(c, how->size, how->lights, how->grey ? 1 : 3);
    for (int k = 0; k < how->lights; k++) {
        if (how->leds)
            rendered_led(k, how->lights, &c->light[k]);
        else if (how->bulbs)
            c->light[k].position = rendered_bulb(k, how->lights);
        else
            c->light[k].direction = rendered_light(k, how->lights);
    }
    if (how->leds || how->bulbs) {
        c->lighting = PST_NEAR;
        c->camera = (pst_camera){.perspective = true,
                                 .focal = 0.5f * (float)how->size / tanf(how->fov * 0.00872664626f),
                                 .center_x = 0.5f * (float)how->size,
                                 .center_y = 0.5f * (float)how->size};
    }
    assert_int_equal(trace_device_new(&device), OK);
    assert_int_equal(trace_scene_new(device, object, scn_surfaces_eval, 1e6, &r.scene), OK);
    for (int i = 0; i < how->size * how->size; i++)
        rendered_pixel(&r, i % how->size, i / how->size);
    trace_scene_free(&r.scene);
    trace_device_free(device);
}

#endif
