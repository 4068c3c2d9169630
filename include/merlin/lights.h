/* SPDX-License-Identifier: MIT */
/* merlin/lights: what objects are lit by: lamps, alone and on domes and orbits; surroundings; the light that was found
 * in a photograph.
 *
 *     for (int i = 0; i < 50; i++) {
 *         const merlin_lamp lamp = merlin_dome_lamp(i, 50, 0);
 *         merlin_relighter_render_lamps(relighter, &lamp, 1, NULL, &picture[i]);
 *     }
 *
 * Places and directions are in the maps' space (merlin/maps.h): the object is about (0, 0, -1), the flash at the lens,
 * (0, 0, 0). */
#ifndef MERLIN_LIGHTS_H
#define MERLIN_LIGHTS_H

#include <merlin/maps.h>
#include <merlin/warnings.h>

#ifdef __cplusplus
extern "C" {
#endif

/* ---- lamps ---- */

typedef struct merlin_lamp {
    float at[3]; /* its place; of a distant lamp the direction toward it, of any length */
    int distant; /* 1: far away: its light is parallel, and everywhere as bright as that of a near one at distance 1 */
    float power[3]; /* by channel, linear: 1 is the flash's (5.95) */
} merlin_lamp;

/* Return a lamp of power 1, 1, 1 at a place, and one far away. */
merlin_lamp merlin_lamp_at(float x, float y, float z);
merlin_lamp merlin_lamp_toward(float x, float y, float z);
/* Returns lamp i of a dome of so many that are spread evenly over the hemisphere in front of the object: far away, or
 * `near` from (0, 0, -1) unless that is 0. */
merlin_lamp merlin_dome_lamp(int i, int count, float near);
/* Computes the unit direction from the object toward that lamp, as .lp files list it. */
void merlin_dome_direction(int i, int count, float direction[3]);
/* Returns lamp i of an orbit of so many at equal steps: on a circle in front of the object, at distance 1 and 50
 * degrees aside, the first to the right. */
merlin_lamp merlin_orbit_lamp(int i, int count);
/* Computes the colour of a lamp of so many kelvin, 1000 to 40000, a black body's: linear, its largest channel 1. */
merlin_status merlin_temperature_color(double kelvin, float color[3]);

/* Lamps of a file. */
typedef struct merlin_lamps {
    merlin_lamp *at;
    size_t count;
    merlin_warnings warnings; /* lights_behind_camera, lights_list (docs/json.md) */
} merlin_lamps;

/* Reads a list of lights (docs/light_lists.md): places, x y z a line; or directions, of an .lp file or as angles, whose
 * lamps are far away or, unless that is 0, `near` from (0, 0, -1). They are as strong as it says. */
merlin_status merlin_lamps_read(const char *path, float near, merlin_lamps *out);
void merlin_lamps_free(merlin_lamps *lamps);

/* ---- surroundings ---- */

/* A latitude-longitude picture, twice as wide as high (Radiance HDR or EXR; up is its top row, straight ahead of the
 * camera its middle column, right of that the camera's right). */
typedef struct merlin_environment merlin_environment;

/* Such files are in no known unit: mean luminance becomes 2^exposure, at 0 a white object about as bright as
 * under the flash. turn: degrees about the vertical; at 90 what was straight ahead is to the camera's right. */
merlin_status merlin_environment_read(const char *path, float turn, float exposure, merlin_environment **out);
void merlin_environment_free(merlin_environment *environment);
/* Turns it further, likewise. */
void merlin_environment_turn(merlin_environment *environment, float turn);
/* Returns the share of the file's values, in [0, 1], that were negative and count as black. */
double merlin_environment_negative(const merlin_environment *environment);

/* ---- the light of a photograph ---- */

/* The light that a model of any light found (maps.light), to be put back. */
typedef struct merlin_found_lights {
    merlin_lamp lamps[2]; /* the flash and the lamp, as far as there are any */
    int count;
    merlin_environment *rest; /* NULL: dark */
} merlin_found_lights;

/* Makes them of what was found, turned about the vertical as merlin_relight_found has it. MERLIN_BAD_INPUT where
 * nothing is known, or all is dark. */
merlin_status merlin_found_lights_new(const merlin_found_light *light, float turn, merlin_found_lights *out);
/* Turns all but a flash at the lens further. */
void merlin_found_lights_turn(merlin_found_lights *lights, float turn);
void merlin_found_lights_free(merlin_found_lights *lights);

/* ---- pictures under lamps, as a capture ---- */

/* Returns how wide the whole photograph is, in degrees, as merlin_capture_files.field_of_view wants it: by its lens,
 * else as if the square `crop` were 60 degrees wide. */
double merlin_maps_field_of_view(const merlin_maps *maps);
/* Takes a place from the maps' space, whose camera looks at the object, to that of the lens, whose axis is the middle
 * of the photograph: as merlin_light.position is for the photograph's whole frame. */
void merlin_maps_lens_place(const merlin_maps *maps, const float place[3], float out[3]);

#ifdef __cplusplus
}
#endif

#endif
