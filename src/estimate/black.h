/* The black level of the relighting decoder.
 *
 *     relit_black_level(&relit);                   after the decoder, before anything is made of its picture
 *
 * The decoder ends in a sigmoid and is taught by squared error, which does not mind a few hundredths of light where
 * there is none; the eye and SSIM do, and half of an object lit from the side is dark. As a camera's, that level is
 * subtracted. The level was chosen on 40 samples of another seed (docs/evaluation.md). */
#ifndef MERLIN_ESTIMATE_BLACK_H
#define MERLIN_ESTIMATE_BLACK_H

#include "image/image.h"

/* Radiance RELIT_BLACK and below becomes 0, radiance 1 stays 1, linear between. */
static const float RELIT_BLACK = 0.025f;
void relit_black_level(img *relit);

#endif
