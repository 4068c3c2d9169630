#include "scene/mesh_obj.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"

/* A number's point without a digit before it; the text goes on for a character on either side. */
static bool is_bare_point(const char *at)
{
    return *at == '.' && (at[-1] == ' ' || at[-1] == '\t') && at[1] >= '0' && at[1] <= '9';
}

static size_t count_bare_points(const char *text, size_t size)
{
    size_t count = 0;
    for (size_t i = 1; i + 1 < size; i++)
        count += is_bare_point(text + i);
    return count;
}

static void copy_with_zeros(const char *text, size_t size, char *out)
{
    for (size_t i = 0; i < size; i++) {
        if (i > 0 && i + 1 < size && is_bare_point(text + i)) *out++ = '0';
        *out++ = text[i];
    }
}

static status tidy(const char *text, size_t size, size_t mark, char **out, size_t *out_size)
{
    size_t points = count_bare_points(text, size);
    if (points == 0 && mark == 0) return OK;
    *out_size = size - mark + points;
    *out = malloc(*out_size + 1);
    if (!*out) return fail(ERROR_MEMORY, "no memory for the mesh");
    copy_with_zeros(text + mark, size - mark, *out);
    return OK;
}

status mesh_tidy_obj(const char *path, char **text, size_t *size)
{
    file_view file;
    *text = NULL;
    *size = 0;
    status s = file_map(path, (size_t)1 << 30, &file);
    if (s != OK) return s;
    if (file.size > 0) s = tidy(file.data, file.size, file_text_mark(file.data, file.size), text, size);
    file_unmap(&file);
    return s;
}
