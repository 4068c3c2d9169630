/* SPDX-License-Identifier: MIT */
#include "merlin/calibrate.h"

#include <stdlib.h>

#include "base/skipped.h"
#include "image/image.h"

void merlin_calibration_free(merlin_calibration *calibration)
{
    merlin_calibration *c = calibration;
    if (!c) return;
    for (int i = 0; c->names && i < c->count; i++)
        free(c->names[i]);
    free(c->names);
    free(c->lights);
    free(c->highlights);
    free(c->residuals);
    free(c->mask_file);
    skipped_free(&c->skipped);
    img_free(&c->brightest);
    *c = (merlin_calibration){0};
}
