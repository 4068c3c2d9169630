/* SPDX-License-Identifier: MIT */
/* merlin/lights.h: lamps, their lists, and the estimated light of a photograph. */
#include <math.h>
#include <stdlib.h>
#include <strings.h>

#include "base/api_needs.h"
#include "base/file.h"
#include "base/lights/light_list.h"
#include "base/lights/light_strengths.h"
#include "base/warnings.h"
#include "estimate/light/found_light.h"
#include "estimate/relight/lamp_of.h"
#include "estimate/relight/relighter.h"
#include "optics/blackbody.h"
#include "optics/camera.h"

merlin_lamp merlin_lamp_at(float x, float y, float z)
{
    return lamp_public(lamp_at(vec3_make(x, y, z)));
}

merlin_lamp merlin_lamp_toward(float x, float y, float z)
{
    return lamp_public(lamp_toward(vec3_make(x, y, z)));
}

/* Returns direction i of a Fibonacci spiral: equal steps of cosθ, the golden angle in φ. */
static vec3 dome_direction(int i, int count)
{
    real cosine = 1 - ((real)i + (real)0.5) / (real)count, sine = sqrt(1 - cosine * cosine);
    real phi = (real)2.39996322972865332 * (real)i;
    return vec3_make(sine * cos(phi), sine * sin(phi), cosine);
}

void merlin_dome_direction(int i, int count, float direction[3])
{
    vec3_put(dome_direction(i, count), direction);
}

merlin_lamp merlin_dome_lamp(int i, int count, float near)
{
    const vec3 direction = dome_direction(i, count);
    return lamp_public(near > 0 ? lamp_at(vec3_fma(object_middle, near, direction)) : lamp_toward(direction));
}

static const real ORBIT_TILT = (real)0.87; /* 50 degrees from the optical axis */

merlin_lamp merlin_orbit_lamp(int i, int count)
{
    real phi = (real)6.28318530717958647692 * (real)i / (real)count, sine = sin(ORBIT_TILT);
    return lamp_public(lamp_at(vec3_make(sine * cos(phi), sine * sin(phi), cos(ORBIT_TILT) - 1)));
}

merlin_status merlin_temperature_color(double kelvin, float color[3])
{
    status s = api_needs(__func__, color);
    if (s == OK && !(kelvin >= 1000 && kelvin <= 40000))
        s = fail(MERLIN_WRONG_USE, "a lamp's temperature is 1000 to 40000 K, not %g", kelvin);
    if (s == OK) vec3_put(blackbody_color(kelvin), color);
    return s;
}

/* ---- lists ---- */

/* Warns about directions in other programs' lists, which as positions would be behind the camera. */
static void note_list(const char *path, const light_list *list, warnings *noticed)
{
    bool behind = list->count > 1 && !list->about_object && !list->angles && light_list_is_unit(list);
    for (size_t i = 0; i < list->count && behind; i++)
        behind = list->at[i].z > 0;
    if (behind)
        warnings_add(noticed, "lights_behind_camera",
                     "the lights in %s are all of length 1 and behind the camera (z above 0), as directions are, and "
                     "were taken for places: an .lp file lists directions",
                     path);
    if (list->note[0]) warnings_add(noticed, "lights_list", "%s: %s", path, list->note);
}

/* Sets the light whose entry has this name. */
static status find_entry(void *context, const char *name, size_t *light)
{
    const light_list *list = context;
    *light = 0;
    while (*light < list->count && !(list->name && strcasecmp(list->name[*light], name) == 0))
        ++*light;
    return OK;
}

static status read_strengths_from(const char *strengths, const char *path, light_list *list)
{
    float(*value)[3] = calloc(list->count, sizeof *value);
    list->intensity = calloc(list->count, sizeof *list->intensity);
    status s = value && list->intensity ? OK : fail(MERLIN_NO_MEMORY, "no memory for %zu intensities", list->count);
    if (s == OK) s = light_strengths_read(strengths, &(light_strengths){list->count, value, find_entry, list, path});
    for (size_t i = 0; i < list->count && s == OK; i++)
        list->intensity[i] = vec3_of(value[i]);
    free(value);
    return s;
}

/* Reads a file of intensities beside the list, if there is one. */
static status read_strengths(const char *path, light_list *list)
{
    char *folder = file_folder_of(path), *strengths = NULL;
    status s = folder ? light_strengths_find(folder, path, list->intensity, &strengths)
                      : fail(MERLIN_NO_MEMORY, "no memory for a file name");
    if (s == OK && strengths) s = read_strengths_from(strengths, path, list);
    free(folder);
    free(strengths);
    return s;
}

static lamp listed(const light_list *list, size_t i, float near)
{
    const vec3 direction = light_list_direction(list, i);
    lamp l = lamp_at(list->at[i]);
    if (list->about_object || list->angles)
        l = near > 0 ? lamp_at(vec3_fma(object_middle, near, direction)) : lamp_toward(direction);
    if (list->intensity) l.tint = list->intensity[i];
    return l;
}

merlin_status merlin_lamps_read(const char *path, float near, merlin_lamps *out)
{
    if (out) *out = (merlin_lamps){.count = 0};
    status s = api_needs(__func__, path && out);
    if (s == OK && !(near >= 0 && near <= 1e6f))
        s = fail(MERLIN_WRONG_USE, "lamps cannot stand %g from the object", (double)near);
    light_list list = {0};
    if (s == OK) s = light_list_read(path, &list);
    if (s != OK) return s;
    s = read_strengths(path, &list);
    if (s == OK) out->at = calloc(list.count, sizeof *out->at);
    if (s == OK && !out->at) s = fail(MERLIN_NO_MEMORY, "no memory for %zu lights", list.count);
    for (; s == OK && out->count < list.count; out->count++)
        out->at[out->count] = lamp_public(listed(&list, out->count, near));
    if (s == OK) note_list(path, &list, &out->warnings);
    light_list_free(&list);
    return s;
}

void merlin_lamps_free(merlin_lamps *lamps)
{
    if (!lamps) return;
    free(lamps->at);
    *lamps = (merlin_lamps){.count = 0};
}

/* ---- the light of a photograph ---- */

static status take_rest(found_lights *lights, merlin_environment **out)
{
    if (!found_lights_rest(lights)) return OK;
    *out = calloc(1, sizeof **out);
    if (!*out) return fail(MERLIN_NO_MEMORY, "no memory for surroundings");
    (*out)->map = lights->rest;
    lights->rest = (env_map){.cosine = 1};
    return OK;
}

merlin_status merlin_found_lights_new(const merlin_found_light *light, float turn, merlin_found_lights *out)
{
    if (out) *out = (merlin_found_lights){.count = 0};
    found_lights lights = {.count = 0};
    status s = api_needs(__func__, light && out);
    if (s == OK && !isfinite(turn)) s = fail(MERLIN_WRONG_USE, "the light's turn must be finite");
    if (s == OK) s = found_light_stand(light, turn, &lights);
    if (s == OK) s = take_rest(&lights, &out->rest);
    for (int i = 0; i < lights.count && s == OK; i++)
        out->lamps[out->count++] = lamp_public(lights.lamps[i]);
    env_map_free(&lights.rest);
    return s;
}

static bool is_at_lens(const lamp *l)
{
    return !l->distant && l->at.x == 0 && l->at.y == 0 && l->at.z == 0;
}

void merlin_found_lights_turn(merlin_found_lights *lights, float turn)
{
    if (!lights || lights->count < 0 || lights->count > 2 || !isfinite(turn)) return;
    found_lights inside = {.count = lights->count};
    for (int i = 0; i < lights->count; i++)
        inside.lamps[i] = lamp_of(&lights->lamps[i]);
    inside.fixed = lights->count > 0 && is_at_lens(&inside.lamps[0]); /* the flash is the first */
    if (lights->rest) inside.rest = lights->rest->map;
    found_lights_turn(&inside, turn);
    for (int i = 0; i < lights->count; i++)
        lights->lamps[i] = lamp_public(inside.lamps[i]);
    if (lights->rest) lights->rest->map = inside.rest;
}

void merlin_found_lights_free(merlin_found_lights *lights)
{
    if (!lights) return;
    merlin_environment_free(lights->rest);
    *lights = (merlin_found_lights){.count = 0};
}

/* ---- as a capture ---- */

double merlin_maps_field_of_view(const merlin_maps *maps)
{
    const double right = (double)maps->slant[0], up = (double)maps->slant[1];
    double wide = maps->fov > 0 ? (double)maps->fov : (double)CAMERA_FOV, forward = sqrt(1 - right * right - up * up);
    double half = tan(wide / 2 * M_PI / 180) / forward * maps->mask.width / maps->crop.side;
    return 2 * atan(half) * 180 / M_PI;
}

void merlin_maps_lens_place(const merlin_maps *maps, const float place[3], float out[3])
{
    const camera_plane plane = camera_plane_of((camera_slant){maps->slant[0], maps->slant[1]});
    const vec3 v = vec3_of(place), back = vec3_cross(plane.right, plane.up);
    vec3_put(vec3_make(vec3_dot(v, plane.right), vec3_dot(v, plane.up), vec3_dot(v, back)), out);
}
