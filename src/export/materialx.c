/* SPDX-License-Identifier: MIT */
#include "export/materialx.h"

#include <math.h>
#include <stdio.h>

#include "base/file.h"
#include "optics/brdf.h"

static void print_image(FILE *f, const char *node, const char *type, const char *file, const char *color_space)
{
    fprintf(f, "  <image name=\"%s\" type=\"%s\">\n", node, type);
    fprintf(f, "    <input name=\"file\" type=\"filename\" value=\"%s\"", file);
    if (color_space) fprintf(f, " colorspace=\"%s\"", color_space);
    fputs("/>\n  </image>\n", f);
}

/* Returns the index of refraction whose reflectance along the normal is F0 (Fresnel). */
static double index_of_refraction(void)
{
    double root = sqrt((double)BRDF_F0);
    return (1 + root) / (1 - root);
}

static void print_material(FILE *f, const void *context)
{
    const bool matte = *(const bool *)context;
    fputs("<?xml version=\"1.0\"?>\n<materialx version=\"1.38\" colorspace=\"lin_rec709\">\n", f);
    print_image(f, "albedo", "color3", "albedo.png", "srgb_texture");
    print_image(f, "roughness", "float", "roughness.png", NULL);
    print_image(f, "normal_picture", "vector3", "normal.png", NULL);
    fputs("  <normalmap name=\"normal\" type=\"vector3\">\n"
          "    <input name=\"in\" type=\"vector3\" nodename=\"normal_picture\"/>\n"
          "  </normalmap>\n"
          "  <standard_surface name=\"surface\" type=\"surfaceshader\">\n"
          "    <input name=\"base\" type=\"float\" value=\"1\"/>\n"
          "    <input name=\"base_color\" type=\"color3\" nodename=\"albedo\"/>\n"
          "    <input name=\"specular_roughness\" type=\"float\" nodename=\"roughness\"/>\n",
          f);
    fprintf(f, "    <input name=\"specular\" type=\"float\" value=\"%d\"/>\n", matte ? 0 : 1);
    fprintf(f, "    <input name=\"specular_IOR\" type=\"float\" value=\"%.4f\"/>\n", index_of_refraction());
    fputs("    <input name=\"normal\" type=\"vector3\" nodename=\"normal\"/>\n"
          "  </standard_surface>\n"
          "  <surfacematerial name=\"merlin\" type=\"material\">\n"
          "    <input name=\"surfaceshader\" type=\"surfaceshader\" nodename=\"surface\"/>\n"
          "  </surfacematerial>\n"
          "</materialx>\n",
          f);
}

status materialx_write(const char *path, bool matte)
{
    return file_print(path, print_material, &matte);
}
