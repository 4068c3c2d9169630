/* SPDX-License-Identifier: MIT */
/* The light of one photograph, mixed of what a sample was rendered under: flash, lamps and surroundings. Light adds, so
 * that any mixture is exact.
 *
 *     train_mixture m;
 *     train_mixture_draw(&view, &rng, &lens, &m);
 *     status s = train_prepare_any(&view, &m, &lens, target, &rng);      behind train_dataset_get
 *
 * What the network is to say of the light is put beside the maps: see model.h, "lighting": "any". */
#ifndef MERLIN_LAB_TRAIN_MIXTURE_H
#define MERLIN_LAB_TRAIN_MIXTURE_H

#include "lab/train/prepare.h"

/* A third of the photographs shows a flash alone, as bright as the samples are; a sixth the surroundings alone; the
 * rest any of them and up to two lamps, exposed as cameras do. */
typedef enum train_kind { TRAIN_FLASH, TRAIN_ROOM, TRAIN_MIXED } train_kind;

typedef struct train_mixture {
    train_kind kind;
    vec3 flash, room, lamp[TRAIN_LAMPS]; /* what each is multiplied by, by channel; zero: off */
    int strongest;                       /* lamp, or -1 */
    float presence;                      /* of that lamp, from 0 to 1 where it makes a sixth of the light */
    bool lens_known, told_flash;         /* what the network is told */
} train_mixture;

/* lens: as train_camera_draw left it; its gain becomes that of the exposure and white balance a camera chooses. */
void train_mixture_draw(const train_view *v, rng *r, train_camera *lens, train_mixture *out);

/* As train_prepare does, of a view with lamps: the photograph is lit by the mixture. Direct, indirect and relit images
 * stay those of flash and target alone; depth becomes relief (nn_render). MERLIN_NO_MEMORY. */
status train_prepare_any(const train_view *v, const train_mixture *m, const train_camera *lens, vec3 target,
                         rng *noise);

#endif
