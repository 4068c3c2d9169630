/* Finds the object of a photograph without help: colours unlike the picture's border are object.
 *
 * Photographs by flash in the dark have a dark background, product photographs an even one; both are what a few colours
 * at the border describe. A cluttered room is not, and the confidence says so. */
#ifndef MERLIN_ESTIMATE_FIND_OBJECT_H
#define MERLIN_ESTIMATE_FIND_OBJECT_H

#include "image/image.h"

/* mask: 1 channel of the photograph's size in [0, 1], edges following the photograph:
 * the heaviest connected region, and others that weigh at least a tenth of it. confidence in [0, 1]: how clearly object
 * and background part; below 0.6 the mask wants a look. ERROR_INPUT if nothing stands out at all. */
status find_object(const img *photo, img *mask, float *confidence);

#endif
