/* SPDX-License-Identifier: MIT */
#include "stereo/calibrate/calibration.h"

#include <stdlib.h>

void pst_calibration_free(pst_calibration *c)
{
    for (int i = 0; c->name && i < c->count; i++)
        free(c->name[i]);
    free(c->name);
    free(c->direction);
    free(c->highlight);
    free(c->residual);
    skipped_free(&c->skipped);
    img_free(&c->brightest);
    *c = (pst_calibration){0};
}
