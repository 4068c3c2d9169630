/* SPDX-License-Identifier: MIT */
/* Warnings that a calibration does not fit its pictures: the shading may not be a matte ball's, the mask not a ball's.
 */
#include <math.h>

#include "stereo/calibrate/calibrate_parts.h"

/* Limit of the root-mean-square residual of shading as a share of the light: painted balls have 0.004 to 0.04; a circle
 * displaced by a third of a radius, or a mirror ball taken for a matte one, 0.07 to 0.2; sRGB taken for linear 0.13. */
static const float UNLIKE = 0.055f;
/* Least overlap of a mask with the circle fitted to its edge; a square has 0.82. */
static const float ROUND = 0.9f;
/* Shares of two circles along which the pictures have an edge: at most for the wrong one, at least for the right one.
 */
static const float HARDLY = 0.2f, PLAINLY = 0.8f;
/* Least share of a circle that was found: of balls' outlines 0.9 and more is seen, of what was none 0.3 to 0.45. */
static const float MOSTLY = 0.6f;
/* Distance in radii from which on two circles are different. */
static const float ELSEWHERE = 0.08f;

static void check_shading(merlin_calibration *c)
{
    float sum = 0;
    for (int i = 0; i < c->count && c->residuals; i++)
        sum += c->residuals[i] / (float)c->count;
    if (sum > UNLIKE)
        warnings_add(
            &c->warnings, "shading_unlike",
            "the ball does not shade like a matte one, by %.0f %% of the light, and lights may be many degrees "
            "off: is it matte, are the values linear (--linear), and is the circle in calibration.png on its "
            "outline?",
            100 * (double)sum);
}

static bool is_within(const merlin_circle *c, int x, int y)
{
    return hypotf((float)x + 0.5f - c->x, (float)y + 0.5f - c->y) < c->radius;
}

/* Returns the intersection over union. The mask may be white on the ball or outside it. */
static double overlap(const img *mask, const merlin_circle *c)
{
    size_t both = 0, either = 0, other_both = 0, other_either = 0;
    for (int y = 0; y < mask->height; y++)
        for (int x = 0; x < mask->width; x++) {
            bool white = *img_at(mask, x, y) > 0.5f, within = is_within(c, x, y);
            both += white && within;
            either += white || within;
            other_both += !white && within;
            other_either += !white || within;
        }
    return fmax((double)both / fmax((double)either, 1), (double)other_both / fmax((double)other_either, 1));
}

static bool is_elsewhere(const merlin_circle *a, const merlin_circle *b)
{
    return hypotf(a->x - b->x, a->y - b->y) + fabsf(a->radius - b->radius) > ELSEWHERE * a->radius;
}

/* Warns about the mask's circle if another one is plainly visible and it is not. */
static status check_place(const img *outlines, merlin_calibration *c)
{
    merlin_circle seen;
    bool found;
    float share = 1, other = 0;
    status s = ball_find(outlines, NULL, &seen, &found);
    if (s == OK) s = ball_share_seen(outlines, &c->circle, &share);
    if (s == OK && found) s = ball_share_seen(outlines, &seen, &other);
    if (s != OK || share > HARDLY || other < PLAINLY || !is_elsewhere(&c->circle, &seen)) return s;
    warnings_add(&c->warnings, "circle_unsure",
                 "the mask's circle, at %.0f, %.0f with radius %.1f, has no edge in the pictures, which have one at "
                 "%.0f, %.0f with radius %.1f, and lights may be many degrees off: is it the mask of this ball?",
                 (double)c->circle.x, (double)c->circle.y, (double)c->circle.radius, (double)seen.x, (double)seen.y,
                 (double)seen.radius);
    return OK;
}

/* Warns about a circle that was found but is hardly seen, as one through the rims of highlights in a black room. */
static status check_outline(const img *outlines, merlin_calibration *c)
{
    float share = 1;
    status s = ball_share_seen(outlines, &c->circle, &share);
    if (s != OK || share >= MOSTLY) return s;
    warnings_add(
        &c->warnings, "circle_unsure",
        "%.0f %% alone of the circle found, at %.0f, %.0f with radius %.1f, is an edge in the pictures, and lights "
        "may be many degrees off: is it the ball's outline in calibration.png? If not, give a mask",
        100 * (double)share, (double)c->circle.x, (double)c->circle.y, (double)c->circle.radius);
    return OK;
}

status ball_check(const img *mask, const img *outlines, merlin_calibration *c)
{
    check_shading(c);
    if (!c->from_mask) return check_outline(outlines, c);
    if (overlap(mask, &c->circle) < (double)ROUND)
        warnings_add(&c->warnings, "mask_not_round",
                     "the mask is no disc, and the circle that fits its edge, at %.0f, %.0f with radius %.1f, may not "
                     "be the ball's outline: compare it in calibration.png",
                     (double)c->circle.x, (double)c->circle.y, (double)c->circle.radius);
    return check_place(outlines, c);
}
