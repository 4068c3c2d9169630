/* SPDX-License-Identifier: MIT */
/* A folder of pictures under many lights, and from it the surface: its files, its mesh, and itself under a new lamp:
 *
 *     capture_to_surface models/merlin-point.safetensors owl out */
#include <stdio.h>

#include "merlin/merlin.h"

static int write_mesh(const merlin_surface *surface, const char *folder)
{
    char path[1024];
    merlin_mesh mesh = {0};
    snprintf(path, sizeof path, "%s/mesh.glb", folder);
    int failed = merlin_mesh_from_surface(surface, &mesh) || merlin_mesh_write(&mesh, path, NULL);
    merlin_mesh_free(&mesh);
    return failed;
}

static int write_relit(merlin_model *model, const merlin_surface *surface, const char *folder)
{
    static const float lamp[3] = {0.7f, 0.3f, -0.4f}; /* to the right of (0, 0, -1), where the surface stands */
    char path[1024];
    merlin_maps maps = {0};
    merlin_image relit = {0};
    snprintf(path, sizeof path, "%s/relit.png", folder);
    int failed = merlin_maps_from_surface(surface, &maps) ||
                 merlin_relight(model, &maps, lamp, MERLIN_BY_BRDF, &relit) || merlin_image_write(path, &relit);
    merlin_image_free(&relit);
    merlin_maps_free(&maps);
    return failed;
}

int main(int argc, char **argv)
{
    merlin_model *model = NULL;
    merlin_capture *capture = NULL;
    merlin_surface surface = {0};
    if (argc != 4) {
        fprintf(stderr, "usage: %s WEIGHTS CAPTURE OUT\n", argv[0]);
        return 2;
    }
    int failed = merlin_model_open(argv[1], &model) || merlin_capture_read(argv[2], NULL, &capture) ||
                 merlin_stereo(capture, NULL, &surface) || merlin_surface_write(&surface, argv[2], NULL, argv[3]) ||
                 write_mesh(&surface, argv[3]) || write_relit(model, &surface, argv[3]);
    if (failed) fprintf(stderr, "%s\n", merlin_error());
    for (size_t i = 0; i < surface.warnings.count; i++)
        fprintf(stderr, "%s\n", surface.warnings.at[i].message);
    merlin_surface_free(&surface);
    merlin_capture_free(capture);
    merlin_model_close(model);
    return failed ? 1 : 0;
}
