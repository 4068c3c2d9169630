/* SPDX-License-Identifier: MIT */
#include "stereo/doubts/model_check.h"

#include <math.h>
#include <stdlib.h>

#include "base/number.h"
#include "image/color.h"
#include "optics/camera.h"
#include "stereo/capture/shrink.h"
#include "stereo/methods/solve.h"

/* Number of pixels that are solved again, up to four times as many; number of pictures; least number, as fewer explain
 * everything. */
enum { SMALL = 200, PICTURES = 16, FEWEST = 4 };
/* Number of pixels whose residuals tell the median of all. */
enum { ENOUGH = 1 << 20 };
/* Residual from which on other models are tried, and the share of it that they must stay below. Measured: in real
 * captures, and rendered ones with gloss and shadows, wrong models leave at least 0.75 of it; linear values taken for
 * sRGB leave twice as much as necessary, a distance wrong by half ten times as much. Under near lights a wrong lens
 * leaves 0.015 where the right one leaves 0.003. */
static const double noticed = 0.02, noticed_near = 0.008, plainly_less = 0.6;

typedef struct check {
    merlin_capture small;
    merlin_stereo_method method;
    double degrees; /* width of the whole pictures, of which the small ones may show a little more */
    double own;     /* residual of the model as it is */
} check;

/* ---- residuals ---- */

status pst_typical_residual(const merlin_capture *c, const merlin_surface *s, double *out)
{
    const size_t pixels = (size_t)c->width * (size_t)c->height, step = pixels / ENOUGH + 1;
    size_t count = 0;
    float *all = malloc((pixels / step + 1) * sizeof *all);
    if (!all) return fail(MERLIN_NO_MEMORY, "no memory for %zu residuals", pixels / step);
    for (size_t i = 0; i < pixels; i += step)
        if (c->mask.data[i] > 0.5f) all[count++] = s->residual.data[i];
    qsort(all, count, sizeof *all, number_ascending);
    *out = count ? (double)all[count / 2] : HUGE_VAL;
    free(all);
    return OK;
}

/* Solves the pictures and measures the residual; infinite if they cannot be solved. */
static status residual_of(const merlin_capture *c, merlin_stereo_method method, double *left)
{
    merlin_surface found;
    status s = pst_solve(c, &(merlin_stereo_params){.method = method}, &found);
    *left = HUGE_VAL;
    if (s != OK) return s == MERLIN_BAD_INPUT ? OK : s;
    if (found.residual.data) s = pst_typical_residual(c, &found, left);
    merlin_surface_free(&found);
    return s;
}

static bool is_better(const check *c, double left)
{
    return left < plainly_less * c->own;
}

/* ---- distance and lens ---- */

static status try_distance(const check *c, double at, double *best, double *factor)
{
    double left;
    merlin_capture other = c->small;
    other.camera.distance *= (float)at;
    status s = residual_of(&other, c->method, &left);
    if (s == OK && left < *best) *best = left, *factor = at;
    return s;
}

/* Tries far and wide distances first: those between may fit worse than either. */
static status check_distance(const check *c, double *best, double *factor)
{
    *best = c->own;
    *factor = 1;
    status s = OK;
    for (int i = -8; i <= 8 && s == OK; i++)
        if (i != 0) s = try_distance(c, pow(1.4, i), best, factor);
    for (double step = sqrt(1.4); step > 1.04 && s == OK; step = sqrt(step)) {
        const double middle = *factor;
        s = try_distance(c, middle * step, best, factor);
        if (s == OK) s = try_distance(c, middle / step, best, factor);
    }
    return s;
}

static double focal_of(const check *c, double degrees)
{
    return (double)c->small.camera.focal * tan(0.5 * c->degrees * (double)DEGREE) / tan(0.5 * degrees * (double)DEGREE);
}

static status check_lens(const check *c, double *best, double *degrees)
{
    static const double tried[] = {12, 18, 24, 30, 36, 45, 52, 60, 75};
    *best = c->own;
    *degrees = c->degrees;
    status s = OK;
    for (size_t i = 0; i < sizeof tried / sizeof *tried && s == OK; i++) {
        double left;
        merlin_capture other = c->small;
        other.camera.focal = (float)focal_of(c, tried[i]);
        s = residual_of(&other, c->method, &left);
        if (left < *best) *best = left, *degrees = tried[i];
    }
    return s;
}

static status check_place(const check *c, warnings *out)
{
    const double distance = (double)c->small.camera.distance;
    double by_distance = HUGE_VAL, factor = 1, by_lens = HUGE_VAL, degrees = 0;
    status s = OK;
    if (distance > 0) s = check_distance(c, &by_distance, &factor);
    if (s == OK) s = check_lens(c, &by_lens, &degrees);
    if (s != OK || !is_better(c, fmin(by_distance, by_lens))) return s;
    if (by_distance <= by_lens)
        warnings_add(out, "other_distance",
                     "the pictures fit these lights far better with the object about %.2g from the camera than %.2g, "
                     "and normals may be many degrees off: is --distance right, and in the unit of the lights?",
                     factor * distance, distance);
    else
        warnings_add(
            out, "other_lens",
            "the pictures fit these lights far better as about %.0f degrees wide than %.0f, and normals may be "
            "many degrees off: state by --fov how wide they are",
            degrees, c->degrees);
    return OK;
}

/* ---- tones and strengths ---- */

static uint16_t other_tone(uint16_t code, bool linear)
{
    float value = (float)code / 65535;
    return (uint16_t)lrintf(65535 * (linear ? srgb_decode(value) : srgb_encode(value)));
}

/* Converts the pictures as if 8 bits had the other of their two usual meanings, and measures the residual. */
static status with_other_tones(check *c, bool linear, double *left)
{
    const size_t codes = (size_t)c->small.width * (size_t)c->small.height * (size_t)c->small.channels;
    for (int k = 0; k < c->small.count; k++) {
        uint16_t *code = c->small.picture[k].wide;
        for (size_t i = 0; i < codes; i++)
            code[i] = other_tone(code[i], linear);
    }
    return residual_of(&c->small, c->method, left);
}

/* Tells whether all lights have one strength; lists without strengths mean equal ones. */
static bool are_of_one_strength(const merlin_capture *c)
{
    for (int k = 1; k < c->count; k++)
        for (int ch = 0; ch < c->channels; ch++)
            if (c->light[k].intensity[ch] != c->light[0].intensity[ch]) return false;
    return c->intensities_known;
}

static void report_tones(const merlin_capture *c, warnings *out)
{
    warnings_add(
        out, "other_tones", "%s",
        c->bits == 16
            ? "the pictures fit their lights far better with sRGB's tones than as linear values, which 16 bits "
              "are where the file says nothing of its tones, and normals may be many degrees off: save them "
              "with an sRGB chunk or profile, or with 8 bits"
        : c->linear ? "the pictures fit their lights far better with sRGB's tones than as linear values, which "
                      "--linear says they are, and normals may be many degrees off: leave it out"
                    : "the pictures fit their lights far better as linear values than with sRGB's tones, and normals "
                      "may be many degrees off: if what wrote them left their values linear, say so by --linear");
}

void pst_warn_strengths(warnings *out)
{
    warnings_add(out, "strengths_unequal",
                 "the pictures fit these lights far better if they are of other strengths than these, and normals "
                 "may be many degrees off: list them in light_intensities.txt, or find them by "
                 "--method semi");
}

/* Measures what is left with the strengths that the pictures fit best, and with equal ones by a solver that heeds
 * shadows and gloss as well. */
static status check_strengths(const check *c, double *found, double *equal)
{
    status s = residual_of(&c->small, MERLIN_STEREO_SEMI, found);
    *equal = HUGE_VAL;
    if (s == OK && c->method == MERLIN_STEREO_LS) s = residual_of(&c->small, MERLIN_STEREO_ROBUST, equal);
    *equal = fmin(*equal, c->own);
    return s;
}

/* Compares tones and strengths, which partly compensate each other, and reports the better one. */
static status check_values(check *c, const merlin_capture *of, warnings *out)
{
    double semi = HUGE_VAL, equal = c->own, toned = HUGE_VAL;
    status s = OK;
    if (of->lighting == MERLIN_DISTANT_LIGHTS && c->method != MERLIN_STEREO_SEMI && are_of_one_strength(of))
        s = check_strengths(c, &semi, &equal);
    /* 16 bits are linear unless the file says otherwise */
    if (s == OK && (of->bits == 8 || of->bits == 16)) s = with_other_tones(c, of->linear || of->bits == 16, &toned);
    if (s != OK) return s;
    const bool strengths = semi < plainly_less * equal;
    if (is_better(c, toned) && (toned < semi || !strengths))
        report_tones(of, out);
    else if (strengths)
        pst_warn_strengths(out);
    return OK;
}

/* ---- the whole ---- */

/* Measures the residual of the model as it is: that of the small pictures, whose solver may miss the surface that was
 * found in the large ones, or, unless it is not noticed anyway, of these. */
static status check_own(check *c, const merlin_capture *of, const merlin_surface *found, double limit)
{
    double whole = HUGE_VAL;
    status s = residual_of(&c->small, c->method, &c->own);
    if (s == OK && c->own > limit && found->residual.data) s = pst_typical_residual(of, found, &whole);
    c->own = fmin(c->own, whole);
    return s;
}

static status check_all(check *c, const merlin_capture *of, const merlin_surface *found, warnings *out)
{
    const double limit = of->lighting == MERLIN_NEAR_LIGHTS ? noticed_near : noticed;
    status s = check_own(c, of, found, limit);
    if (s != OK || !(c->own > limit) || isinf(c->own)) return s;
    size_t before = out->count;
    if (of->lighting == MERLIN_NEAR_LIGHTS) s = check_place(c, out);
    if (s == OK && out->count == before && c->own > noticed) s = check_values(c, of, out);
    return s;
}

status pst_check_model(const merlin_capture *c, const merlin_surface *s, warnings *out)
{
    /* other lights and lenses are tried by the solver of the same lights, without a network */
    check all = {.method = s->method == MERLIN_STEREO_NFPS ? MERLIN_STEREO_NEAR : s->method,
                 .degrees = (double)pinhole_field_of_view(&c->camera, c->width)};
    if (c->lighting == MERLIN_UNKNOWN_LIGHTS || c->count < FEWEST) return OK;
    int picture[PICTURES];
    status result = pst_shrink_to(c, SMALL, PICTURES, picture, &all.small);
    if (result == OK) result = check_all(&all, c, s, out);
    pst_capture_free(&all.small);
    return result;
}
