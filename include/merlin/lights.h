/* SPDX-License-Identifier: MIT */
/* merlin/lights: light for objects: lamps, alone and on domes and orbits; environments; the estimated light of a
 * photograph.
 *
 *     for (int i = 0; i < 50; i++) {
 *         const merlin_lamp lamp = merlin_dome_lamp(i, 50, 0);
 *         merlin_relighter_render_lamps(relighter, &lamp, 1, NULL, &picture[i]);
 *     }
 *
 * Positions and directions are in the maps' space (merlin/maps.h): the object is near (0, 0, -1), the flash at the
 * lens, (0, 0, 0). */
#ifndef MERLIN_LIGHTS_H
#define MERLIN_LIGHTS_H

#include <merlin/maps.h>
#include <merlin/warnings.h>

#ifdef __cplusplus
extern "C" {
#endif

/* ---- lamps ---- */

typedef struct merlin_lamp {
    float at[3];    /* position; for a distant lamp the direction toward it, of any length */
    int distant;    /* 1: distant, with parallel light, everywhere as bright as that of a near lamp at distance 1 */
    float power[3]; /* power in each channel, linear: 1 is the flash's (5.95) */
} merlin_lamp;

/* Return a lamp of power 1, 1, 1 at a position, and a distant one. */
merlin_lamp merlin_lamp_at(float x, float y, float z);
merlin_lamp merlin_lamp_toward(float x, float y, float z);
/* Returns lamp i of a dome of `count` lamps, evenly spread over the hemisphere in front of the object: distant, or at
 * the distance `near` from (0, 0, -1) unless that is 0. */
merlin_lamp merlin_dome_lamp(int i, int count, float near);
/* Computes the unit direction from the object toward that lamp, as in .lp files. */
void merlin_dome_direction(int i, int count, float direction[3]);
/* Returns lamp i of an orbit of `count` lamps at equal steps: on a circle in front of the object, at distance 1 and 50
 * degrees aside, the first to the right. */
merlin_lamp merlin_orbit_lamp(int i, int count);
/* Computes the colour of a black body of this temperature in kelvin, 1000 to 40000: linear, its largest channel 1. */
merlin_status merlin_temperature_color(double kelvin, float color[3]);

/* Lamps of a file. */
typedef struct merlin_lamps {
    merlin_lamp *at;
    size_t count;
    merlin_warnings warnings; /* lights_behind_camera, lights_list (docs/json.md) */
} merlin_lamps;

/* Reads a list of lights (docs/light_lists.md) with its intensities, or those of a file beside it: positions, x y z per
 * line; or directions, from an .lp file or as angles, whose lamps are distant or, unless that is 0, at the distance
 * `near` from (0, 0, -1). */
merlin_status merlin_lamps_read(const char *path, float near, merlin_lamps *out);
void merlin_lamps_free(merlin_lamps *lamps);

/* ---- environments ---- */

/* An environment: a latitude-longitude picture, twice as wide as high (Radiance HDR or EXR); its top row is up, its
 * middle column straight ahead of the camera, right of that the camera's right. */
typedef struct merlin_environment merlin_environment;

/* Reads an environment. Its mean luminance becomes 2^exposure, as files have no known unit; with 0 white is about as
 * bright as under the flash. turn: degrees about the vertical; 90 moves what was ahead to the camera's right. */
merlin_status merlin_environment_read(const char *path, float turn, float exposure, merlin_environment **out);
void merlin_environment_free(merlin_environment *environment);
/* Turns it further in the same direction. */
void merlin_environment_turn(merlin_environment *environment, float turn);
/* Returns the share of the file's values, in [0, 1], that were negative and count as black. */
double merlin_environment_negative(const merlin_environment *environment);

/* ---- the light of a photograph ---- */

/* The light that a model of any light estimated (maps.light), for relighting. */
typedef struct merlin_found_lights {
    merlin_lamp lamps[2]; /* the flash and the lamp, if there are any */
    int count;
    merlin_environment *rest; /* NULL: dark */
} merlin_found_lights;

/* Makes them from the estimate, turned about the vertical as by merlin_relight_found. MERLIN_BAD_INPUT if nothing is
 * known, or all is dark. */
merlin_status merlin_found_lights_new(const merlin_found_light *light, float turn, merlin_found_lights *out);
/* Turns everything but a flash at the lens further. */
void merlin_found_lights_turn(merlin_found_lights *lights, float turn);
void merlin_found_lights_free(merlin_found_lights *lights);

/* ---- pictures under lamps, as a capture ---- */

/* Returns the horizontal field of view of the whole photograph in degrees, for merlin_capture_files.field_of_view: by
 * its lens, else as if the square `crop` were 60 degrees wide. */
double merlin_maps_field_of_view(const merlin_maps *maps);
/* Converts a position from the maps' space, whose camera looks at the object, to that of the lens, whose axis is at the
 * middle of the photograph: that of merlin_light.position for the photograph's whole frame. */
void merlin_maps_lens_place(const merlin_maps *maps, const float place[3], float out[3]);

#ifdef __cplusplus
}
#endif

#endif
