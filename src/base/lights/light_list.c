/* SPDX-License-Identifier: MIT */
#include "base/lights/light_list.h"

#include <stdlib.h>
#include <strings.h>

#include "base/file.h"

const char *const light_list_names[] = {"lights.txt", "lights.csv", "lights.tsv", "lights.dat", NULL};

bool light_list_is_name(const char *name)
{
    for (int i = 0; light_list_names[i]; i++)
        if (strcasecmp(name, light_list_names[i]) == 0) return true;
    return file_ends_in(name, ".lp");
}

void light_list_free(light_list *list)
{
    for (size_t i = 0; list->name && i < list->count; i++)
        free(list->name[i]);
    free(list->name);
    free(list->at);
    free(list->intensity);
    free(list->line);
    *list = (light_list){0};
}

bool light_list_is_unit(const light_list *list)
{
    for (size_t i = 0; i < list->count; i++)
        if (fabsf(vec3_length(list->at[i]) - 1) > 1e-3f) return false;
    return true;
}
