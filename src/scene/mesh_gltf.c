#include "scene/mesh_gltf.h"

#include <cJSON.h>
#include <stdint.h>
#include <string.h>

#include "base/file.h"

enum { GLB_JSON = 20 }; /* where a GLB's JSON begins; its size stands eight bytes before */

/* The JSON of a GLB, else all of the file. */
static const char *find_json(const file_view *file, size_t *size)
{
    const char *text = file->data;
    *size = file->size;
    if (file->size < GLB_JSON || memcmp(text, "glTF", 4) != 0) return text;
    uint32_t length;
    memcpy(&length, text + GLB_JSON - 8, sizeof length);
    *size = length < file->size - GLB_JSON ? length : file->size - GLB_JSON;
    return text + GLB_JSON;
}

static status check_extension(const char *name)
{
    static const char *const unread[] = {"KHR_mesh_quantization", "EXT_meshopt_compression", "KHR_meshopt_compression",
                                         "EXT_mesh_gpu_instancing"};
    for (size_t i = 0; i < sizeof unread / sizeof *unread; i++)
        if (strcmp(name, unread[i]) == 0)
            return fail(ERROR_INPUT, "its extension %s is not supported; export it without", name);
    return OK;
}

status mesh_check_gltf(const char *path)
{
    file_view file;
    status s = file_map(path, (size_t)1 << 30, &file);
    if (s != OK) return s;
    size_t size;
    const char *text = find_json(&file, &size);
    cJSON *root = cJSON_ParseWithLength(text, size);
    file_unmap(&file);
    const cJSON *name;
    cJSON_ArrayForEach(name, cJSON_GetObjectItemCaseSensitive(root, "extensionsRequired"))
    {
        if (s == OK && cJSON_IsString(name)) s = check_extension(name->valuestring);
    }
    cJSON_Delete(root);
    return s;
}
