/* SPDX-License-Identifier: MIT */
/* Aligns pictures of an object by one camera that moved a little between them, each under another light.
 *
 *     merlin_capture aligned;
 *     picture_shifts shifts;
 *     status s = align_pictures(&capture, &aligned, &shifts);
 *     ... aligned instead of capture ...
 *     align_pictures_free(&capture, &aligned);
 */
#ifndef MERLIN_PHOTO_STEREO_ALIGN_PICTURES_H
#define MERLIN_PHOTO_STEREO_ALIGN_PICTURES_H

#include "stereo/capture/capture.h"

/* Shifts of a capture's pictures by which they fit the first one. */
typedef struct picture_shifts {
    int moved;       /* number of pictures that have one */
    int most, which; /* largest shift, in pixels, and the picture that has it */
} picture_shifts;

/* Makes a capture whose pictures lie as the first one does: it shares with the original all that is not a picture that
 * had to be moved. What comes from beyond the edges is black. Edges are compared, as light changes all else: of each
 * picture with those of all others, within the mask and a margin, or everywhere without one. A picture
 * that moved from where the others are is shifted by at most a twentieth of the longer side; if all moved, no two by
 * more than an eighth from each other; and none unless it is clearly better so. MERLIN_BAD_INPUT if one plainly moved
 * further (far_pictures.h). */
status align_pictures(const merlin_capture *c, merlin_capture *out, picture_shifts *shifts);
void align_pictures_free(const merlin_capture *c, merlin_capture *aligned);

#endif
