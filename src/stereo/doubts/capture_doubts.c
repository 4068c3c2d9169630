/* SPDX-License-Identifier: MIT */
#include "stereo/doubts/capture_doubts.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "stereo/algebra/dense.h"
#include "stereo/doubts/light_check.h"
#include "stereo/doubts/model_check.h"

/* Number of pixels and values that are examined. */
enum { SOME = 1 << 16 };
/* Least ratio of the smallest to the largest spread of unit directions: a ring of lights 6 degrees from its axis has
 * 0.08, and ten times the errors of lights from all around. */
static const double alike = 0.08;
/* Cosine between the directions of lights that may have the same picture. */
static const float same_direction = 0.9994f;
/* Sine of the elevation below which a light is not just at the horizon. */
static const float behind = -0.05f;
/* Sine of the elevation above which a near light is not just next to the camera. */
static const float behind_camera = 0.1f;
/* Ratio of the lights' distance from the object to the object's from the camera from which on their units differ. */
static const float another_unit = 30;
/* Share of the object's pixels that are saturated in half of the pictures. */
static const double much_burnt_out = 0.05;

/* Mean spread of normals in degrees from which on hardly anything checks them: 5 to 17 of most surfaces of five and
 * more pictures, 50 to 90 of three and four, where errors of 20 degrees leave no residual. */
static const double much_spread = 30;

/* ---- lights ---- */

static void check_directions(const merlin_capture *c, warnings *out)
{
    double m[9] = {0}, spread[6];
    int away = 0;
    for (int k = 0; k < c->count; k++) {
        vec3 d = vec3_of(c->light[k].direction);
        const double v[3] = {d.x, d.y, d.z};
        for (int j = 0; j < 9; j++)
            m[j] += v[j / 3] * v[j % 3];
        away += d.z < behind;
    }
    if (away)
        warnings_add(
            out, "lights_behind",
            "%d of %d lights stand behind the object (z below 0), where they light nothing that is seen: z of a "
            "direction points toward the camera",
            away, c->count);
    if (dense_eigen(m, 3, false, spread) && spread[0] < alike * alike * spread[2])
        warnings_add(out, "lights_alike",
                     "the lights come from nearly one direction or one plane, which enlarges every error of the "
                     "pictures: light the object from more sides");
}

/* Warns about positions behind the camera. Positions relative to the object, or with z away from the camera, explain
 * the pictures nearly as well. */
static void check_positions(const merlin_capture *c, warnings *out)
{
    for (int k = 0; k < c->count; k++)
        if (c->light[k].position[2] < behind_camera * vec3_length(vec3_of(c->light[k].position))) return;
    warnings_add(
        out, "lights_behind_camera",
        "all %d lights are listed behind the camera (z above 0): places are from the camera, and what is before it "
        "has negative z; those about the object go into an .lp file, with --distance",
        c->count);
}

static void check_unit(const merlin_capture *c, warnings *out)
{
    float distance = c->camera.distance, sum = 0;
    if (!(distance > 0)) return;
    for (int k = 0; k < c->count; k++)
        sum += vec3_length(vec3_sub(vec3_of(c->light[k].position), vec3_make(0, 0, -distance))) / (float)c->count;
    if (sum < another_unit * distance && sum * another_unit > distance) return;
    warnings_add(
        out, "other_unit",
        "the lights are %.3g from the object and the camera %.3g: are the lights' places and --distance in one "
        "unit?",
        (double)sum, (double)distance);
}

/* ---- pictures ---- */

static uint64_t hash_of(const pst_plane *picture, size_t count)
{
    uint64_t hash = 14695981039346656037u;
    for (size_t i = 0, step = count / SOME + 1; i < count; i += step)
        hash = (hash ^ pst_code(picture, i)) * 1099511628211u;
    return hash;
}

static bool are_the_same(const merlin_capture *c, const uint64_t *hash, int j, int k)
{
    size_t values = (size_t)c->width * (size_t)c->height * (size_t)c->channels;
    return hash[j] == hash[k] && pst_plane_equals(&c->picture[j], &c->picture[k], values);
}

static bool may_be_the_same(const merlin_capture *c, int j, int k)
{
    const merlin_light *a = &c->light[j], *b = &c->light[k];
    if (c->lighting == MERLIN_DISTANT_LIGHTS)
        return vec3_dot(vec3_of(a->direction), vec3_of(b->direction)) > same_direction;
    vec3 apart = vec3_sub(vec3_of(a->position), vec3_of(b->position));
    return c->lighting == MERLIN_NEAR_LIGHTS && !(vec3_length(apart) > 1e-3f * vec3_length(vec3_of(a->position)));
}

status pst_check_copies(const merlin_capture *c, warnings *out)
{
    size_t values = (size_t)c->width * (size_t)c->height * (size_t)c->channels;
    int copies = 0, first = 0, second = 0;
    uint64_t *hash = malloc((size_t)c->count * sizeof *hash);
    if (!hash) return fail(MERLIN_NO_MEMORY, "no memory for %d pictures' sums", c->count);
    for (int k = 0; k < c->count; k++) {
        hash[k] = hash_of(&c->picture[k], values);
        int j = 0;
        while (j < k && (may_be_the_same(c, j, k) || !are_the_same(c, hash, j, k)))
            j++;
        if (j == k) continue;
        if (copies++ == 0) first = j, second = k;
    }
    free(hash);
    if (copies)
        warnings_add(out, "same_pictures",
                     "pictures %d and %d%s are the same, value for value: was one copied in another's place?",
                     first + 1, second + 1, copies > 1 ? ", and others," : "");
    return OK;
}

static bool is_saturated(const merlin_capture *c, int k, size_t pixel)
{
    for (int ch = 0; ch < c->channels; ch++)
        if (pst_code(&c->picture[k], pixel * (size_t)c->channels + (size_t)ch) >= PST_SATURATED * 65535) return true;
    return false;
}

static void check_exposure(const merlin_capture *c, warnings *out)
{
    size_t pixels = (size_t)c->width * (size_t)c->height, step = pixels / SOME + 1, seen = 0, burnt = 0;
    for (size_t i = 0; i < pixels; i += step) {
        if (c->mask.data[i] <= 0.5f) continue;
        int saturated = 0;
        for (int k = 0; k < c->count; k++)
            saturated += is_saturated(c, k, i);
        seen++;
        burnt += 2 * saturated >= c->count;
    }
    if (seen && (double)burnt > much_burnt_out * (double)seen)
        warnings_add(
            out, "burnt_out",
            "%.0f %% of the object is burnt out in half of the pictures or more, where normals are guesses: take "
            "them darker",
            100 * (double)burnt / (double)seen);
}

/* Returns a pixel's brightest value as a share of full scale. */
static float brightest_at(const merlin_capture *c, size_t pixel)
{
    size_t channels = (size_t)c->channels;
    uint16_t most = 0;
    for (int k = 0; k < c->count; k++)
        for (size_t ch = 0; ch < channels; ch++) {
            const uint16_t code = pst_code(&c->picture[k], pixel * channels + ch);
            most = code > most ? code : most;
        }
    return (float)most / 65535;
}

/* Warns about a mask whose pixels are black in all pictures while the rest is bright, as lamps point at the object. */
static void check_mask(const merlin_capture *c, warnings *out)
{
    size_t pixels = (size_t)c->width * (size_t)c->height, step = pixels / SOME + 1, inside = 0, outside = 0;
    size_t black = 0, bright = 0;
    for (size_t i = 0; i < pixels; i += step) {
        bool object = c->mask.data[i] > 0.5f;
        float most = brightest_at(c, i);
        inside += object;
        outside += !object;
        black += object && most < 0.02f;
        bright += !object && most > 0.1f;
    }
    if (2 * black > inside && 2 * bright > outside)
        warnings_add(
            out, "mask_inverted",
            "%.0f %% of what the mask shows is black in every picture, and %.0f %% of what it hides is bright: is "
            "it inverted? The object is white in a mask",
            100 * (double)black / (double)inside, 100 * (double)bright / (double)outside);
}

/* ---- warnings of solvers and readers ---- */

static void report_reading(const merlin_capture *c, warnings *out)
{
    if (c->reduced > 1)
        warnings_add(out, "reduced_size",
                     "the pictures were read at a reduced size: %d x %d of their pixels became one", c->reduced,
                     c->reduced);
    if (c->frames > 1)
        warnings_add(out, "first_frame", "%s is an animation, of whose %d pictures the first alone was read",
                     c->name[0], c->frames);
    warnings_append(out, &c->noticed);
}

static void report_strengths(const merlin_surface *s, warnings *out)
{
    if (s->method == MERLIN_STEREO_UNCALIBRATED)
        warnings_add(out, "strengths_unequal",
                     "the lights do not seem equally strong, or the pictures' exposures were not the same, and normals "
                     "may be many degrees off: fix the exposure, or list the strengths in light_intensities.txt");
    else
        warnings_add(
            out, "strengths_unsure",
            "the object is too flat or the pictures are too few to tell how strong the lights are, and normals "
            "may be many degrees off: state the strengths in light_intensities.txt");
}

/* Warns where hardly anything checks the normals: three values determine one, whatever is wrong with them. */
static void check_spread(const merlin_surface *s, warnings *out)
{
    double sum = 0;
    size_t count = 0;
    for (size_t i = 0; s->spread.data && i < img_value_count(&s->mask); i++) {
        if (!(s->mask.data[i] > 0.5f)) continue;
        sum += (double)s->spread.data[i];
        count++;
    }
    if (sum > much_spread * (double)count)
        warnings_add(
            out, "normals_unchecked",
            "without single pictures normals would be others by %.0f degrees on average, as most of the surface "
            "is lit in three pictures or so, which show no error of lights, exposures and tones: take more",
            sum / (double)count);
}

static void report_solution(const merlin_capture *c, const merlin_surface *s, warnings *out)
{
    if (c->lens_assumed)
        warnings_add(
            out, "lens_assumed",
            "nothing tells the lens, and 60 degrees were assumed, by which normals may be many degrees off: state "
            "by --fov how wide the pictures are");
    if (c->about_object)
        warnings_add(out, "lights_have_places",
                     "the lights are listed as places about the object and were taken for directions: --near heeds "
                     "places");
    if (c->lights_in_order)
        warnings_add(
            out, "lights_in_order",
            "none of the pictures that the lights' list names is there: its lights were taken in the order of the "
            "pictures' names");
    if (s->strengths_unsure) report_strengths(s, out);
    if (s->distance_unsure)
        warnings_add(out, "distance_unsure",
                     "these lights do not tell how far the object is, and normals may be many degrees off: state it by "
                     "--distance, or take more lights, at different heights");
    if (s->lights_unsure)
        warnings_add(
            out, "lights_unsure",
            "the pictures hardly tell where the lights are, and normals may be many degrees off, or bulge where "
            "the object recedes: state the lights' directions in lights.txt");
}

status pst_doubts(const merlin_capture *c, const merlin_surface *s, warnings *out)
{
    bool known = s->method != MERLIN_STEREO_UNCALIBRATED;
    status result = known ? pst_check_lights(c, s, out) : OK;
    const bool explained = warnings_find(out, "lights_do_not_fit") || warnings_find(out, "strengths_unequal");
    if (known && result == OK && !explained) result = pst_check_model(c, s, out);
    if (known && c->lighting == MERLIN_DISTANT_LIGHTS) check_directions(c, out);
    if (known && c->lighting == MERLIN_NEAR_LIGHTS) check_positions(c, out);
    if (known && c->lighting == MERLIN_NEAR_LIGHTS) check_unit(c, out);
    if (result == OK) result = pst_check_copies(c, out);
    check_exposure(c, out);
    check_mask(c, out);
    report_reading(c, out);
    report_solution(c, s, out);
    if (known) check_spread(s, out);
    return result;
}

status pst_doubt_pictures(const merlin_capture *c, warnings *out)
{
    status s = pst_check_copies(c, out);
    if (!c->mask_found && c->mask.data) check_mask(c, out);
    report_reading(c, out);
    return s;
}
