/* SPDX-License-Identifier: MIT */
#include "merlin/calibrate.h"

#include <stdio.h>
#include <stdlib.h>

#include "base/api_needs.h"
#include "base/number.h"
#include "stereo/calibrate/calibrate_parts.h"
#include "stereo/capture/capture_parts.h"
#include "stereo/doubts/capture_doubts.h"
#include "stereo/fit/pixel_fit.h"

static float grey(const uint16_t *pixel, int channels)
{
    float sum = 0;
    for (int k = 0; k < channels; k++)
        sum += pixel[k];
    return sum / (65535 * (float)channels);
}

/* Returns the mean over channels; fully saturated if one channel is, as a mean with a clipped channel is no shading. */
static float shading(const uint16_t *pixel, int channels)
{
    for (int k = 0; k < channels; k++)
        if ((float)pixel[k] >= PST_SATURATED * 65535) return 1;
    return grey(pixel, channels);
}

static const uint16_t *pixel_of(const merlin_capture *c, int picture, size_t pixel, uint16_t code[3])
{
    const size_t channels = (size_t)c->channels;
    return pst_codes(&c->picture[picture], pixel * channels, channels, code);
}

static size_t pixels_of(const merlin_capture *c)
{
    return (size_t)c->width * (size_t)c->height;
}

static status find_brightest(const merlin_capture *c, img *out)
{
    status s = img_new(out, c->width, c->height, 3);
    for (int i = 0; i < c->count && s == OK; i++)
        for (size_t p = 0; p < 3 * pixels_of(c); p++) {
            float value = (float)pst_code(&c->picture[i], c->channels == 3 ? p : p / 3) / 65535;
            out->data[p] = fmaxf(out->data[p], value);
        }
    return s;
}

/* Smooths one channel by 3 × 3 binomial means; the border is unchanged. */
static status smooth(img *p)
{
    img from;
    status s = img_copy(&from, p);
    if (s != OK) return s;
    for (int y = 1; y < p->height - 1; y++)
        for (int x = 1; x < p->width - 1; x++) {
            float sum = 0;
            for (int dy = -1; dy <= 1; dy++)
                for (int dx = -1; dx <= 1; dx++)
                    sum += *img_at(&from, x + dx, y + dy) * (float)((2 - dx * dx) * (2 - dy * dy));
            *img_at(p, x, y) = sum / 16;
        }
    img_free(&from);
    return OK;
}

/* Makes the picture in which the outline is searched: the logarithm, so that a dark ball in front of a darker room has
 * an edge as well. */
static status outline_picture(const img *brightest, img *out)
{
    static const float NOISE = 0.002f;
    status s = img_new(out, brightest->width, brightest->height, 1);
    if (s != OK) return s;
    size_t pixels = (size_t)out->width * (size_t)out->height;
    for (size_t p = 0; p < pixels; p++) {
        const float *v = brightest->data + 3 * p;
        out->data[p] = logf((v[0] + v[1] + v[2]) / 3 + NOISE);
    }
    s = smooth(out);
    return s == OK ? smooth(out) : s;
}

/* Finds each pixel's darkest value, without the highlights, which move. */
static status find_darkest(const merlin_capture *c, img *out)
{
    img darkest;
    status s = img_new(&darkest, c->width, c->height, 3);
    if (s != OK) return s;
    for (int i = 0; i < c->count; i++)
        for (size_t p = 0; p < 3 * pixels_of(c); p++) {
            float value = (float)pst_code(&c->picture[i], c->channels == 3 ? p : p / 3) / 65535;
            darkest.data[p] = i ? fminf(darkest.data[p], value) : value;
        }
    s = outline_picture(&darkest, out);
    img_free(&darkest);
    return s;
}

static status search_outlines(const merlin_capture *c, merlin_ball ball, const img *picture, ball_outlines *out)
{
    img darkest = {0};
    status s = find_darkest(c, &darkest);
    if (s == OK) s = ball_list_outlines(picture, &darkest, ball, out);
    img_free(&darkest);
    return s;
}

/* Finds the outline of the mask, or the picture to search in and its candidate outlines. */
static status find_outlines(const char *folder, const merlin_calibrate_params *options, const merlin_capture *c,
                            merlin_calibration *out, img *picture, ball_outlines *outlines)
{
    char *mask;
    bool found = false;
    *outlines = (ball_outlines){0};
    status s = pst_find_mask(folder, options->mask, &mask);
    if (s != OK) return s;
    out->from_mask = mask != NULL;
    s = mask ? img_copy(picture, &c->mask) : outline_picture(&out->brightest, picture);
    if (s == OK && mask) s = smooth(picture);
    if (s == OK && mask) s = ball_find(picture, NULL, &outlines->at[0], &found);
    if (s == OK && !mask) s = search_outlines(c, options->ball, picture, outlines);
    if (found) outlines->count = 1;
    if (s == OK && outlines->count == 0)
        s = mask ? fail(MERLIN_BAD_INPUT, "the mask %s is not round", mask)
                 : fail(MERLIN_BAD_INPUT, "no ball is seen in the pictures of %s; give its outline as a mask", folder);
    out->mask_file = mask;
    return s;
}

/* Finds what every picture contains, such as a window's reflection in the ball; zero for fewer than three pictures. */
static void find_constant(const merlin_capture *c, img *constant)
{
    uint16_t code[3];
    for (int i = 0; i < c->count && c->count > 2; i++)
        for (size_t p = 0; p < pixels_of(c); p++) {
            float value = grey(pixel_of(c, i, p, code), c->channels);
            constant->data[p] = i ? fminf(constant->data[p], value) : value;
        }
}

/* Subtracts the constant part from a picture; clipped values stay clipped. */
static status take_picture(const merlin_capture *c, int i, merlin_ball ball, const img *constant, img *out)
{
    status s = img_new(out, c->width, c->height, 1);
    for (size_t p = 0; p < pixels_of(c) && s == OK; p++) {
        uint16_t code[3];
        const uint16_t *pixel = pixel_of(c, i, p, code);
        float value = ball == MERLIN_CHROME_BALL ? grey(pixel, c->channels) : shading(pixel, c->channels);
        out->data[p] = ball == MERLIN_MATTE_BALL && value == 1 ? 1 : value - constant->data[p];
    }
    return s;
}

/* Finds the light of the room in every picture of a matte ball, from the sides that the lights found so far do not
 * reach: the median over pictures, as no such side is visible if a light is near the camera. */
static status find_room(const merlin_capture *c, const ball_view *view, const merlin_calibration *found, img *constant)
{
    float *level = malloc((size_t)c->count * sizeof *level);
    if (!level) return fail(MERLIN_NO_MEMORY, "no memory for a room's light");
    size_t count = 0;
    status s = OK;
    for (int i = 0; i < c->count && s == OK; i++) {
        img picture;
        s = take_picture(c, i, MERLIN_MATTE_BALL, constant, &picture);
        if (s == OK) count += ball_dark_level(&picture, view, vec3_of(found->lights[i].direction), &level[count]);
        img_free(&picture);
    }
    qsort(level, count, sizeof *level, number_ascending);
    for (size_t p = 0; p < pixels_of(c) && count > 0; p++)
        constant->data[p] = level[count / 2];
    free(level);
    return s;
}

static status find_light(const merlin_capture *c, int i, const img *constant, const ball_view *view,
                         merlin_calibration *out)
{
    img picture;
    status s = take_picture(c, i, out->ball, constant, &picture);
    if (s != OK) return s;
    vec3 direction = {0, 0, 0};
    s = out->ball == MERLIN_CHROME_BALL ? ball_mirror_light(&picture, view, &out->highlights[i], &direction)
                                        : ball_shading_light(&picture, view, &out->residuals[i], &direction);
    vec3_put(direction, out->lights[i].direction);
    img_free(&picture);
    if (s == MERLIN_BAD_INPUT && !out->from_mask)
        s = fail_in(s, "the ball found at %.0f, %.0f with radius %.0f (if it is not there, give its outline by a mask)",
                    (double)out->circle.x, (double)out->circle.y, (double)out->circle.radius);
    return s == OK ? OK : fail_in(s, "%s", out->names[i]);
}

static status find_lights(const merlin_capture *c, const img *constant, const ball_view *view, merlin_calibration *out)
{
    status s = OK;
    for (int i = 0; i < c->count && s == OK; i++)
        s = find_light(c, i, constant, view, out);
    return s;
}

static status reserve(int count, merlin_calibration *out)
{
    out->count = count;
    out->lights = calloc((size_t)count, sizeof *out->lights);
    if (out->ball == MERLIN_CHROME_BALL)
        out->highlights = calloc((size_t)count, sizeof *out->highlights);
    else
        out->residuals = calloc((size_t)count, sizeof *out->residuals);
    return out->lights && (out->highlights || out->residuals) ? OK : fail(MERLIN_NO_MEMORY, "no memory for lights");
}

/* Finds all lights for one outline. */
static status calibrate_by(const merlin_capture *c, const img *picture, merlin_calibration *out)
{
    img constant = {0};
    ball_view view = {.circle = out->circle, .camera = c->camera};
    status s = img_new(&constant, c->width, c->height, 1);
    if (s == OK && c->camera.focal > 0) s = ball_center(picture, &c->camera, &out->circle, &view.center);
    if (s == OK && out->ball == MERLIN_CHROME_BALL) find_constant(c, &constant);
    if (s == OK) s = reserve(c->count, out);
    if (s == OK) s = find_lights(c, &constant, &view, out);
    if (s == OK && out->ball == MERLIN_MATTE_BALL) s = find_room(c, &view, out, &constant);
    if (s == OK && out->ball == MERLIN_MATTE_BALL) s = find_lights(c, &constant, &view, out);
    img_free(&constant);
    return s;
}

/* ---- choice of the outline ---- */

static float mean_residual(const merlin_calibration *c)
{
    float sum = 0;
    for (int i = 0; i < c->count; i++)
        sum += c->residuals[i] / (float)c->count;
    return sum;
}

static int lights_behind(const merlin_calibration *c)
{
    int count = 0;
    for (int i = 0; i < c->count; i++)
        count += c->lights[i].direction[2] < 0;
    return count;
}

/* Tells whether a less likely outline is better than the best so far: a matte ball's shading must fit, a mirror ball's
 * lights must not be behind it. */
static bool is_better(const merlin_calibration *trial, const merlin_calibration *best)
{
    static const float CLEARLY = 0.8f;
    if (trial->ball == MERLIN_MATTE_BALL) return mean_residual(trial) < CLEARLY * mean_residual(best);
    return lights_behind(trial) == 0 && lights_behind(best) > 0;
}

static void take_lights(merlin_calibration *from, merlin_calibration *to)
{
    free(to->lights);
    free(to->highlights);
    free(to->residuals);
    to->circle = from->circle;
    to->count = from->count;
    to->lights = from->lights;
    to->highlights = from->highlights;
    to->residuals = from->residuals;
    from->lights = NULL;
    from->highlights = NULL;
    from->residuals = NULL;
}

/* Chooses an outline; if all fail, the first one's error is reported. */
static status choose_outline(const merlin_capture *c, const img *picture, ball_outlines *outlines,
                             merlin_calibration *out, int *chosen)
{
    status first = OK;
    char words[512] = "";
    *chosen = -1;
    for (int i = 0; i < outlines->count; i++) {
        merlin_calibration trial = {
            .ball = out->ball, .circle = outlines->at[i], .from_mask = out->from_mask, .names = c->name};
        status s = calibrate_by(c, picture, &trial);
        outlines->residual[i] = s == OK && out->ball == MERLIN_MATTE_BALL ? mean_residual(&trial) : 2;
        if (s == OK && (*chosen < 0 || is_better(&trial, out))) {
            take_lights(&trial, out);
            *chosen = i;
        }
        if (i == 0 && (first = s) != OK) snprintf(words, sizeof words, "%s", status_message());
        trial.names = NULL;
        merlin_calibration_free(&trial);
        if (s != OK && s != MERLIN_BAD_INPUT) return s;
    }
    return *chosen >= 0 ? OK : fail(first, "%s", words);
}

/* Tells whether an inner circle of this size is the horizon of a wide table in a mirror ball. */
static bool is_horizon(float ratio)
{
    return ratio > 0.67f && ratio < 0.74f;
}

/* Tells whether the choice between two nested circles is certain. */
static bool is_decided(const ball_outlines *outlines, merlin_ball ball, int chosen)
{
    static const float CLEARLY = 0.6f;
    if (ball == MERLIN_CHROME_BALL) return chosen == 0 && is_horizon(outlines->ratio);
    return outlines->residual[chosen] < CLEARLY * outlines->residual[1 - chosen];
}

static void check_choice(const ball_outlines *outlines, int chosen, merlin_calibration *c)
{
    const merlin_circle *other = &outlines->at[1 - chosen % 2];
    if (outlines->nested && chosen < 2 && !is_decided(outlines, c->ball, chosen))
        warnings_add(
            &c->warnings, "circle_unsure",
            "two circles may be the ball's outline, one of radius %.1f within one of %.1f, and that of %.1f was "
            "taken: if calibration.png does not show it on the outline, give a mask",
            (double)fminf(other->radius, c->circle.radius), (double)fmaxf(other->radius, c->circle.radius),
            (double)c->circle.radius);
    if (chosen == (outlines->nested ? 2 : 1))
        warnings_add(
            &c->warnings, "circle_unsure",
            "the ball was taken to be at %.0f, %.0f with radius %.1f, beside what looks most like one but does not "
            "shine like one: if calibration.png does not show it there, give a mask",
            (double)c->circle.x, (double)c->circle.y, (double)c->circle.radius);
    int behind = lights_behind(c);
    if (behind)
        warnings_add(
            &c->warnings, "lights_behind",
            "%d of %d lights would stand behind the ball: if the circle in calibration.png is not its outline, "
            "give a mask",
            behind, c->count);
}

static status check_fit(const merlin_capture *c, merlin_calibration *out)
{
    img outlines = {0};
    status s = outline_picture(&out->brightest, &outlines);
    if (s == OK) s = ball_check(&c->mask, &outlines, out);
    if (s == OK) s = pst_check_copies(c, &out->warnings);
    img_free(&outlines);
    return s;
}

static status calibrate(const char *folder, const merlin_calibrate_params *options, merlin_capture *c,
                        merlin_calibration *out)
{
    img picture = {0};
    ball_outlines outlines;
    int chosen = 0;
    status s = find_brightest(c, &out->brightest);
    if (s == OK) s = find_outlines(folder, options, c, out, &picture, &outlines);
    if (s == OK) s = choose_outline(c, &picture, &outlines, out, &chosen);
    if (s == OK) check_choice(&outlines, chosen, out);
    if (s == OK) s = check_fit(c, out);
    img_free(&picture);
    if (s != OK) return s;
    out->names = c->name;
    c->name = NULL;
    return OK;
}

static status check_params(const merlin_calibrate_params *p)
{
    if (p->ball != MERLIN_CHROME_BALL && p->ball != MERLIN_MATTE_BALL)
        return fail(MERLIN_WRONG_USE, "no ball has the number %d", (int)p->ball);
    if (p->field_of_view >= 0 && p->field_of_view <= 170) return OK;
    return fail(MERLIN_WRONG_USE, "a camera's field of view is 0 (far away) to 170 degrees, not %g",
                (double)p->field_of_view);
}

merlin_status merlin_calibrate(const char *folder, const merlin_calibrate_params *params, merlin_calibration *out)
{
    if (out) *out = (merlin_calibration){0};
    status s = api_needs(__func__, folder && params && out);
    if (s == OK) s = check_params(params);
    if (s != OK) return s;
    out->ball = params->ball;
    const merlin_capture_files reading = {.mask = params->mask,
                                          .unknown_lights = 1,
                                          .linear = params->linear,
                                          .stop = params->stop,
                                          .progress = params->progress,
                                          .progress_context = params->progress_context};
    merlin_capture c;
    s = pst_capture_read(folder, &reading, &c);
    if (s != OK) return s;
    c.camera = pinhole_known(c.width, c.height, params->field_of_view, c.focal_35mm);
    s = calibrate(folder, params, &c, out);
    out->skipped = c.skipped;
    c.skipped = (skipped_files){0};
    pst_capture_free(&c);
    if (s != OK) merlin_calibration_free(out);
    return s;
}
