/* SPDX-License-Identifier: MIT */
/* The functions of libvips, which vips_begin (image/vips_start.h) loads when they are first needed.
 *
 *     status s = vips_begin();
 *     if (s == OK) failed = vips()->autorot(image, &made, NULL);
 */
#ifndef MERLIN_IMAGE_VIPS_LIBRARY_H
#define MERLIN_IMAGE_VIPS_LIBRARY_H

#include <stdbool.h>
#include <vips/vips.h>

#include "base/status.h"

/* Functions of libvips that are used: vips_NAME for every NAME. */
#define VIPS_FUNCTIONS(USE)                                                                                            \
    USE(autorot)                                                                                                       \
    USE(band_format_get_type)                                                                                          \
    USE(band_format_isint)                                                                                             \
    USE(bandjoin2)                                                                                                     \
    USE(cache_set_max)                                                                                                 \
    USE(cast)                                                                                                          \
    USE(colourspace)                                                                                                   \
    USE(concurrency_set)                                                                                               \
    USE(copy)                                                                                                          \
    USE(enum_nick)                                                                                                     \
    USE(error_buffer)                                                                                                  \
    USE(error_clear)                                                                                                   \
    USE(extract_band)                                                                                                  \
    USE(gifload)                                                                                                       \
    USE(gifsave_buffer)                                                                                                \
    USE(heifload)                                                                                                      \
    USE(icc_transform)                                                                                                 \
    USE(image_copy_memory)                                                                                             \
    USE(image_get_bands)                                                                                               \
    USE(image_get_blob)                                                                                                \
    USE(image_get_coding)                                                                                              \
    USE(image_get_format)                                                                                              \
    USE(image_get_height)                                                                                              \
    USE(image_get_interpretation)                                                                                      \
    USE(image_get_n_pages)                                                                                             \
    USE(image_get_orientation)                                                                                         \
    USE(image_get_typeof)                                                                                              \
    USE(image_get_width)                                                                                               \
    USE(image_hasalpha)                                                                                                \
    USE(image_new_from_memory)                                                                                         \
    USE(image_set_array_int)                                                                                           \
    USE(image_set_int)                                                                                                 \
    USE(image_write_to_memory)                                                                                         \
    USE(init)                                                                                                          \
    USE(interpretation_get_type)                                                                                       \
    USE(jpegload)                                                                                                      \
    USE(linear1)                                                                                                       \
    USE(pngload)                                                                                                       \
    USE(premultiply)                                                                                                   \
    USE(rad2float)                                                                                                     \
    USE(radload)                                                                                                       \
    USE(sink_disc)                                                                                                     \
    USE(svgload_buffer)                                                                                                \
    USE(tiffload)                                                                                                      \
    USE(type_find)                                                                                                     \
    USE(unpremultiply)                                                                                                 \
    USE(version)                                                                                                       \
    USE(webpload)                                                                                                      \
    USE(webpsave_buffer)

/* Functions of GLib, on which libvips is built: g_NAME. */
#define GLIB_FUNCTIONS(USE)                                                                                            \
    USE(free)                                                                                                          \
    USE(log_set_handler)                                                                                               \
    USE(markup_escape_text)                                                                                            \
    USE(object_ref)                                                                                                    \
    USE(object_unref)                                                                                                  \
    USE(type_from_name)                                                                                                \
    USE(utf8_make_valid)

#define VIPS_MEMBER(name) __typeof__(vips_##name) *name;
#define GLIB_MEMBER(name) __typeof__(g_##name) *g_##name;
typedef struct vips_functions {
    VIPS_FUNCTIONS(VIPS_MEMBER)
    GLIB_FUNCTIONS(GLIB_MEMBER)
} vips_functions;
#undef VIPS_MEMBER
#undef GLIB_MEMBER

/* Loads the functions without starting libvips: only for vips_begin (image/vips_start.h). */
status vips_load(void);
/* Returns the functions; to be called after vips_begin. */
const vips_functions *vips(void);

/* Replaces *image by the result of an operation; returns false if that failed. made is a pointer so that the
 * operation's call can be the last argument: the order in which arguments are evaluated is unspecified. */
bool vips_pass_on(VipsImage **image, VipsImage *const *made, int failed);

#endif
