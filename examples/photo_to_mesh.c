/* SPDX-License-Identifier: MIT */
/* One photograph, lit from thirty places, and from these pictures its surface:
 *
 *     photo_to_mesh models/merlin-point.safetensors photo.jpg out.glb */
#include <math.h>
#include <stdio.h>

#include "merlin/merlin.h"

enum { LIGHTS = 30, SIDE = 256 };

/* Spread over the frontal hemisphere about (0, 0, -1), as far down as 60 degrees off the axis; of a flash's power, in
 * units of what the pictures show as white. */
static merlin_light light_at(int k, float gain)
{
    float cosine = 1 - 0.5f * ((float)k + 0.5f) / LIGHTS, sine = sqrtf(1 - cosine * cosine), phi = 2.399963f * (float)k;
    float power = 5.95f / (3.14159265f * gain);
    return (merlin_light){.position = {sine * cosf(phi), sine * sinf(phi), cosine - 1},
                          .intensity = {power, power, power}};
}

static int add_pictures(merlin_relighter *relighter, float gain, merlin_capture *capture)
{
    int failed = 0;
    for (int k = 0; k < LIGHTS && !failed; k++) {
        merlin_image picture = {0};
        merlin_light light = light_at(k, gain);
        failed = merlin_relighter_render(relighter, light.position, NULL, &picture) ||
                 merlin_capture_add(capture, &picture, &light);
        merlin_image_free(&picture);
    }
    return failed;
}

int main(int argc, char **argv)
{
    merlin_model *model = NULL;
    merlin_image photo = {0}, alpha = {0};
    merlin_maps maps = {0};
    merlin_relighter *relighter = NULL;
    merlin_capture *capture = NULL;
    merlin_surface surface = {0};
    merlin_mesh mesh = {0};
    if (argc != 4) {
        fprintf(stderr, "usage: %s WEIGHTS PHOTO OUT.glb\n", argv[0]);
        return 2;
    }
    const merlin_capture_params near_lights = {.lighting = MERLIN_NEAR_LIGHTS, .distance = 1};
    int failed = merlin_model_open(argv[1], &model) || merlin_image_read(argv[2], &photo, &alpha) ||
                 merlin_estimate(model, &photo, &alpha, NULL, &maps) ||
                 merlin_relighter_new(model, &maps, SIDE, MERLIN_BY_BRDF_UNSHADOWED, &relighter) ||
                 merlin_capture_new(&near_lights, NULL, &capture) || add_pictures(relighter, maps.gain, capture) ||
                 merlin_stereo(capture, NULL, &surface) || merlin_mesh_from_surface(&surface, &mesh) ||
                 merlin_mesh_write(&mesh, argv[3], NULL);
    if (failed) fprintf(stderr, "%s\n", merlin_error());
    merlin_mesh_free(&mesh);
    merlin_surface_free(&surface);
    merlin_capture_free(capture);
    merlin_relighter_free(relighter);
    merlin_maps_free(&maps);
    merlin_image_free(&photo);
    merlin_image_free(&alpha);
    merlin_model_close(model);
    return failed ? 1 : 0;
}
