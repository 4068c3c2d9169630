/* SPDX-License-Identifier: MIT */
/* OBJ files from arbitrary bytes. */
#include "mesh/read/mesh_read_obj.h"

#include "fuzz_mesh.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    triangle_mesh mesh = {0};
    int parts = 0;
    char *text = fuzz_text(data, size);
    status s = mesh_parse_obj(text, size, 100000, &mesh, &parts);
    fuzz_check_mesh(&mesh, s, parts);
    free(text);
    return 0;
}
