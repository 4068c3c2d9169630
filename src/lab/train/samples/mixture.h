/* SPDX-License-Identifier: MIT */
/* The light of a training photograph: a mixture of the lights under which a sample was rendered, flash, lamps and
 * surroundings. Light is additive, so that any mixture is exact.
 *
 *     train_mixture m;
 *     train_mixture_draw(&view, &config, &rng, NULL, &lens, &m);
 *     status s = train_prepare_any(&view, &m, &lens, target, &rng);      after train_dataset_get
 *
 * The light that the network has to predict is stored beside the maps: see model.h, "lighting": "any". */
#ifndef MERLIN_LAB_TRAIN_SAMPLES_MIXTURE_H
#define MERLIN_LAB_TRAIN_SAMPLES_MIXTURE_H

#include "lab/train/samples/prepare.h"

/* Kinds of mixtures. A third of the photographs, or the configured share, shows only a flash, as bright as in the
 * samples; a sixth only the surroundings; the rest any of them and up to two lamps, exposed as cameras do. */
typedef enum train_kind { TRAIN_FLASH, TRAIN_ROOM, TRAIN_MIXED } train_kind;

typedef struct train_mixture {
    train_kind kind;
    vec3 flash, room, lamp[TRAIN_LAMPS]; /* factor for each, by channel; zero: off */
    int strongest;                       /* index of the strongest lamp, or -1 */
    float presence;                      /* of that lamp, rising from 0 to 1 where it makes a sixth of the light */
    bool lens_known, told_flash;         /* what the network is told */
    float shift[2];                      /* of the picture to the right and downwards, pixels */
} train_mixture;

/* One of several pictures of an object. In six of ten captures each picture has one lamp of its own, as a torch that
 * a hand moves or the lights of a dome, beside surroundings that stay as they are: what calibrates lights and compares
 * pictures best. In the others each picture is a mixture by itself. */
typedef struct train_capture {
    bool torch;
    int picture; /* index of this picture */
    int lamp;    /* of the first picture by a torch; the following ones have the following lamps */
    float room;  /* weight of the surroundings beside a torch */
    vec3 color;  /* of the torch */
} train_capture;

/* Chooses what an object's pictures have in common. steady: a generator that all of them share. */
train_capture train_capture_draw(rng *steady, int picture);

/* Chooses a mixture, with the kinds' shares of c. capture: NULL of the only picture of an object. Of several, all but
 * the first are mixed ones, as the same flash or surroundings alone would only repeat what it shows. lens: as set by
 * train_camera_draw; its gain becomes that of the exposure and white balance which a camera chooses. */
void train_mixture_draw(const train_view *v, const train_config *c, rng *r, const train_capture *capture,
                        train_camera *lens, train_mixture *out);

/* Chooses how far the hand that holds the camera has moved since the object's first picture. steady: a generator that
 * all its pictures share, as a third of all cameras stand on something; r: the picture's own. */
void train_mixture_move(int size, rng *steady, rng *r, train_mixture *out);

/* Prepares a view with lamps as train_prepare does, except that the photograph is lit by the mixture. Direct, indirect
 * and relit images are those of flash and target alone; depth becomes relief (nn_render). MERLIN_NO_MEMORY. */
status train_prepare_any(const train_view *v, const train_mixture *m, const train_camera *lens, vec3 target,
                         rng *noise);

#endif
