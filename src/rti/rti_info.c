/* SPDX-License-Identifier: MIT */
/* info.json as relight's and OpenLIME's viewers read it. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/json/json_put.h"
#include "rti/rti_write.h"

/* Appends a number with as many digits as a float has. */
static void append_float(cJSON *array, double number)
{
    const double digits = number == 0 ? 1 : pow(10, 7 - ceil(log10(fabs(number))));
    json_append(array, cJSON_CreateNumber(round(number * digits) / digits));
}

static void put_lights(cJSON *to, const merlin_rti *rti)
{
    cJSON *lights = json_put_array(to, "lights");
    for (int i = 0; i < 3 * rti->count; i++)
        append_float(lights, (double)rti->direction[i]);
}

/* The mean comes first, a value in [0, 1] for each light and channel; it is 0. */
static void put_basis(cJSON *to, const rti_components *components)
{
    cJSON *basis = json_put_array(to, "basis");
    for (int k = 0; k < components->length; k++)
        json_append(basis, cJSON_CreateNumber(0));
    for (int i = 0; i < components->planes * components->length; i++)
        json_append(basis, cJSON_CreateNumber(components->codes[i]));
}

static void put_materials(cJSON *to, const rti_planes *planes, const rti_components *components)
{
    cJSON *material = json_append_object(json_put_array(to, "materials"));
    if (components) {
        cJSON *range = json_put_array(material, "range");
        for (int p = 0; p < planes->planes; p++)
            append_float(range, (double)components->range[p]);
    }
    cJSON *scale = json_put_array(material, "scale"), *bias = json_put_array(material, "bias");
    for (int p = 0; p < planes->planes; p++) {
        append_float(scale, (double)planes->scale[p]);
        append_float(bias, planes->zero[p] / 255.0);
    }
}

static const char *colorspace(merlin_rti_basis basis)
{
    return basis == MERLIN_RTI_LRGB ? "lrgb" : basis == MERLIN_RTI_RBF ? "mrgb" : "rgb";
}

status rti_write_info(const char *path, const merlin_rti *rti, const rti_planes *planes,
                      const rti_components *components)
{
    cJSON *o = cJSON_CreateObject();
    json_put_number(o, "width", planes->width);
    json_put_number(o, "height", planes->height);
    json_put_text(o, "format", "jpg");
    json_put_text(o, "type", rti_basis_name(rti->how.basis));
    json_put_text(o, "colorspace", colorspace(rti->how.basis));
    json_put_text(o, "colorprofile", "sRGB");
    json_put_number(o, "nplanes", planes->planes);
    json_put_number(o, "quality", rti->how.quality);
    put_materials(o, planes, components);
    put_lights(o, rti);
    if (components) json_put_number(o, "sigma", round(1e5 * rti_sigma(rti)) / 1e5);
    if (components) put_basis(o, components);
    char *text = json_print(o);
    cJSON_Delete(o);
    if (!text) return fail(MERLIN_NO_MEMORY, "no memory for info.json");
    status s = file_write(path, text, strlen(text));
    free(text);
    return s;
}
