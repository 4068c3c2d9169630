/* SPDX-License-Identifier: MIT */
/* The light of a training photograph: a mixture of the lights under which a sample was rendered, flash, lamps and
 * surroundings. Light is additive, so that any mixture is exact.
 *
 *     train_mixture m;
 *     train_mixture_draw(&view, &rng, false, &lens, &m);
 *     status s = train_prepare_any(&view, &m, &lens, target, &rng);      after train_dataset_get
 *
 * The light that the network has to predict is stored beside the maps: see model.h, "lighting": "any". */
#ifndef MERLIN_LAB_TRAIN_MIXTURE_H
#define MERLIN_LAB_TRAIN_MIXTURE_H

#include "lab/train/prepare.h"

/* Kinds of mixtures. A third of the photographs shows only a flash, as bright as in the samples; a sixth only the
 * surroundings; the rest any of them and up to two lamps, exposed as cameras do. */
typedef enum train_kind { TRAIN_FLASH, TRAIN_ROOM, TRAIN_MIXED } train_kind;

typedef struct train_mixture {
    train_kind kind;
    vec3 flash, room, lamp[TRAIN_LAMPS]; /* factor for each, by channel; zero: off */
    int strongest;                       /* index of the strongest lamp, or -1 */
    float presence;                      /* of that lamp, rising from 0 to 1 where it makes a sixth of the light */
    bool lens_known, told_flash;         /* what the network is told */
    float shift[2];                      /* of the picture to the right and downwards, pixels */
} train_mixture;

/* Chooses a mixture. further: of an object that has a picture already, which the same flash or surroundings alone would
 * only repeat, so that it is a mixed one. lens: as set by train_camera_draw; its gain becomes that of the exposure and
 * white balance which a camera chooses. */
void train_mixture_draw(const train_view *v, rng *r, bool further, train_camera *lens, train_mixture *out);

/* Chooses how far the hand that holds the camera has moved since the object's first picture. steady: a generator that
 * all its pictures share, as a third of all cameras stand on something; r: the picture's own. */
void train_mixture_move(int size, rng *steady, rng *r, train_mixture *out);

/* Prepares a view with lamps as train_prepare does, except that the photograph is lit by the mixture. Direct, indirect
 * and relit images are those of flash and target alone; depth becomes relief (nn_render). MERLIN_NO_MEMORY. */
status train_prepare_any(const train_view *v, const train_mixture *m, const train_camera *lens, vec3 target,
                         rng *noise);

#endif
