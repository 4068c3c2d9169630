/* SPDX-License-Identifier: MIT */
/* PLY files from arbitrary bytes. */
#include "mesh/read/mesh_read_ply.h"

#include "fuzz_mesh.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    triangle_mesh mesh = {0};
    char *text = fuzz_text(data, size);
    status s = mesh_parse_ply(text, size, &mesh);
    fuzz_check_mesh(&mesh, s, 1);
    free(text);
    return 0;
}
