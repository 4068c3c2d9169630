/* A capture with fewer, larger pixels: what slow searches start on.
 *
 *     pst_capture small;
 *     status s = pst_shrink(&capture, 4, 0.98f, &small);
 *     ... find its depth ...
 *     pst_enlarge(&depth, &small.mask, &capture.mask, 4, &out);
 *     pst_capture_free(&small); */
#ifndef MERLIN_STEREO_SHRINK_H
#define MERLIN_STEREO_SHRINK_H

#include "stereo/capture.h"

/* Every pixel the mean of factor × factor on the object; where one of them reaches the share `saturation` of full
 * scale, saturated itself. On the object is what holds a pixel of it. Names and truth are left out. */
status pst_shrink(const pst_capture *c, int factor, float saturation, pst_capture *out);

/* Values between the means of 1 channel, for the pixels of mask that the small mask covers; out has the mask's size. */
void pst_enlarge(const img *small, const img *small_mask, const img *mask, int factor, img *out);

#endif
