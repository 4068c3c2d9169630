/* SPDX-License-Identifier: MIT */
/* glTF and GLB files from arbitrary bytes. */
#include "mesh/read/mesh_read_gltf.h"

#include "fuzz_mesh.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    triangle_mesh mesh = {0};
    int parts = 0;
    status s = mesh_parse_gltf(data, size, NULL, &mesh, &parts);
    fuzz_check_mesh(&mesh, s, parts);
    return 0;
}
