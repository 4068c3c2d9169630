/* SPDX-License-Identifier: MIT */
/* One photograph, lit from the left:
 *
 *     relight_photo models/merlin-point.safetensors photo.jpg out.png */
#include <stdio.h>

#include "merlin/merlin.h"

int main(int argc, char **argv)
{
    static const float from_the_left[3] = {-0.8f, 0.3f, -0.5f};
    merlin_model *model = NULL;
    merlin_image photo = {0}, alpha = {0}, relit = {0};
    merlin_maps maps = {0};
    if (argc != 4) {
        fprintf(stderr, "usage: %s WEIGHTS PHOTO OUT.png\n", argv[0]);
        return 2;
    }
    int failed = merlin_model_open(argv[1], &model) || merlin_image_read(argv[2], &photo, &alpha) ||
                 merlin_estimate(model, &photo, &alpha, NULL, &maps) ||
                 merlin_relight(model, &maps, from_the_left, MERLIN_BY_BRDF, &relit) ||
                 merlin_image_write(argv[3], &relit);
    if (failed) fprintf(stderr, "%s\n", merlin_error());
    merlin_image_free(&relit);
    merlin_image_free(&photo);
    merlin_image_free(&alpha);
    merlin_maps_free(&maps);
    merlin_model_close(model);
    return failed ? 1 : 0;
}
