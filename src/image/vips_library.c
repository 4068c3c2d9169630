/* SPDX-License-Identifier: MIT */
#include "image/vips_library.h"

#include "base/library.h"

static vips_functions functions;
#define WANT_VIPS(name) {"vips_" #name, &functions.name},
#define WANT_GLIB(name) {"g_" #name, &functions.g_##name},
static const library_function wanted[] = {VIPS_FUNCTIONS(WANT_VIPS) GLIB_FUNCTIONS(WANT_GLIB)};
static library libvips = {.file = MERLIN_VIPS, .functions = wanted, .count = sizeof wanted / sizeof *wanted};

status vips_load(void)
{
    return library_need(&libvips);
}

const vips_functions *vips(void)
{
    return &functions;
}

bool vips_pass_on(VipsImage **image, VipsImage *const *made, int failed)
{
    if (failed) return false;
    functions.g_object_unref(*image);
    *image = *made;
    return true;
}
