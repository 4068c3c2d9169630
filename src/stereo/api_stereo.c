/* SPDX-License-Identifier: MIT */
/* Implements include/merlin/stereo.h. */
#include "merlin/stereo.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/api_needs.h"
#include "base/progress.h"
#include "image/read/read.h"
#include "stereo/doubts/capture_doubts.h"
#include "stereo/guided.h"
#include "stereo/integrate/surface_statistics.h"
#include "stereo/methods/place_lights.h"
#include "stereo/methods/solve.h"

/* ---- pictures and lights ---- */

static status check_camera(float field_of_view, float distance)
{
    if (!(field_of_view >= 0 && field_of_view <= 170))
        return fail(MERLIN_WRONG_USE, "a capture's field of view is 0 (not known) to 170 degrees, not %g",
                    (double)field_of_view);
    if (!(distance >= 0 && isfinite(distance)))
        return fail(MERLIN_WRONG_USE, "a capture's distance is 0 (not known) or above, not %g", (double)distance);
    return OK;
}

/* Source of a capture: a folder or a video, or pictures one by one. */
typedef struct capture_source {
    const char *folder;
    const char *const *pictures;
    size_t count;
} capture_source;

static status read_from(const capture_source *from, const merlin_capture_files *files, merlin_capture **out)
{
    static const merlin_capture_files usual = {0};
    if (!files) files = &usual;
    status s = check_camera(files->field_of_view, files->distance);
    if (s == OK && (files->frames < 0 || files->frames > PST_MOST_FRAMES))
        s = fail(MERLIN_WRONG_USE, "from a video 1 to %d frames are taken, not %d", PST_MOST_FRAMES, files->frames);
    if (s != OK) return s;
    merlin_capture *c = calloc(1, sizeof *c);
    if (!c) return fail(MERLIN_NO_MEMORY, "no memory for a capture");
    const double began = clock_seconds();
    s = from->folder ? pst_capture_read(from->folder, files, c)
                     : pst_capture_read_pictures(from->pictures, from->count, files, c);
    c->seconds_read = clock_seconds() - began;
    if (s != OK)
        merlin_capture_free(c);
    else
        *out = c;
    return s;
}

merlin_status merlin_capture_read(const char *folder, const merlin_capture_files *files, merlin_capture **out)
{
    if (out) *out = NULL;
    status s = api_needs(__func__, folder && out);
    return s == OK ? read_from(&(capture_source){.folder = folder}, files, out) : s;
}

merlin_status merlin_capture_read_pictures(const char *const *pictures, size_t count, const merlin_capture_files *files,
                                           merlin_capture **out)
{
    if (out) *out = NULL;
    status s = api_needs(__func__, pictures && count > 0 && out);
    for (size_t i = 0; i < count && s == OK; i++)
        s = api_needs(__func__, pictures[i] != NULL);
    return s == OK ? read_from(&(capture_source){.pictures = pictures, .count = count}, files, out) : s;
}

static status check_params(const merlin_capture_params *p)
{
    if (p->lighting < MERLIN_DISTANT_LIGHTS || p->lighting > MERLIN_UNKNOWN_LIGHTS)
        return fail(MERLIN_WRONG_USE, "no lighting has the number %d", (int)p->lighting);
    return check_camera(p->field_of_view, p->distance);
}

static status take_mask(const merlin_image *mask, merlin_capture *c)
{
    if (!mask || !mask->data) return OK;
    if (mask->width < 1 || mask->height < 1) return fail(MERLIN_WRONG_USE, "the mask has no pixels");
    if (mask->channels != 1) return fail(MERLIN_WRONG_USE, "a mask has 1 channel, not %d", mask->channels);
    status s = img_copy(&c->mask, mask);
    for (size_t i = 0; s == OK && i < img_value_count(&c->mask); i++)
        c->mask.data[i] = c->mask.data[i] >= 0.5f;
    c->width = mask->width;
    c->height = mask->height;
    return s;
}

merlin_status merlin_capture_new(const merlin_capture_params *params, const merlin_image *mask, merlin_capture **out)
{
    static const merlin_capture_params usual = {0};
    if (out) *out = NULL;
    status s = api_needs(__func__, out);
    if (!params) params = &usual;
    if (s == OK) s = check_params(params);
    if (s != OK) return s;
    merlin_capture *c = calloc(1, sizeof *c);
    if (!c) return fail(MERLIN_NO_MEMORY, "no memory for a capture");
    *c = (merlin_capture){.lighting = params->lighting,
                          .intensities_known = !params->unknown_intensities,
                          .camera.distance = params->distance,
                          .field_of_view = params->field_of_view};
    s = take_mask(mask, c);
    if (s != OK) {
        merlin_capture_free(c);
        return s;
    }
    *out = c;
    return MERLIN_OK;
}

static status check_picture(const merlin_capture *c, const merlin_image *p)
{
    if (!p->data || p->width < 1 || p->height < 1) return fail(MERLIN_WRONG_USE, "the picture has no pixels");
    if (p->channels != 1 && p->channels != 3)
        return fail(MERLIN_WRONG_USE, "a capture's pictures have 1 or 3 channels, not %d", p->channels);
    if (c->width && (p->width != c->width || p->height != c->height))
        return fail(MERLIN_WRONG_USE, "a picture of %d x %d pixels does not fit a capture of %d x %d", p->width,
                    p->height, c->width, c->height);
    if (c->count && p->channels != c->channels)
        return fail(MERLIN_WRONG_USE, "a picture of %d channels does not fit a capture of %d", p->channels,
                    c->channels);
    for (size_t i = 0; i < img_value_count(p); i++)
        if (!isfinite(p->data[i])) return fail(MERLIN_BAD_INPUT, "the picture has values that are not finite");
    return OK;
}

static bool are_finite(const float v[3])
{
    return isfinite(v[0]) && isfinite(v[1]) && isfinite(v[2]);
}

/* Copies a light with what the solvers rely on: a direction of length 1, an intensity. */
static status take_light(merlin_lighting lighting, const merlin_light *from, merlin_light *to)
{
    static const merlin_light nothing = {0};
    if (!from && lighting != MERLIN_UNKNOWN_LIGHTS)
        return fail(MERLIN_WRONG_USE, "a light is missing: this capture's lights are known");
    *to = from ? *from : nothing;
    if (!are_finite(to->direction) || !are_finite(to->position) || !are_finite(to->intensity) ||
        !(to->lobe >= 0 && isfinite(to->lobe)))
        return fail(MERLIN_WRONG_USE, "a light's direction, position, intensity or lobe is not a number");
    vec3 d = vec3_of(to->direction);
    real length = vec3_length(d);
    if (lighting == MERLIN_DISTANT_LIGHTS && !(length > 0))
        return fail(MERLIN_WRONG_USE, "a distant light has no direction");
    vec3_put(length > 0 ? vec3_scale(d, 1 / length) : (vec3){0, 0, 0}, to->direction);
    bool any = to->intensity[0] != 0 || to->intensity[1] != 0 || to->intensity[2] != 0;
    for (int k = 0; k < 3 && !any; k++)
        to->intensity[k] = 1;
    return OK;
}

merlin_status merlin_capture_add(merlin_capture *capture, const merlin_image *picture, const merlin_light *light)
{
    status s = api_needs(__func__, capture && picture);
    if (s != OK) return s;
    merlin_light taken;
    s = check_picture(capture, picture);
    if (s == OK) s = take_light(capture->lighting, light, &taken);
    if (s != OK) return s;
    capture->width = picture->width;
    capture->height = picture->height;
    capture->channels = picture->channels;
    pst_capture_see(capture, capture->field_of_view, capture->camera.distance);
    return pst_capture_add(capture, picture, &taken);
}

merlin_status merlin_capture_add_file(merlin_capture *capture, const char *path, int linear, const merlin_light *light)
{
    img picture = {0};
    int bits;
    status s = api_needs(__func__, capture && path);
    if (s == OK) s = img_read_samples(path, !linear, &picture, &bits);
    if (s == OK) s = merlin_capture_add(capture, &picture, light);
    img_free(&picture);
    return s;
}

merlin_lighting merlin_capture_lighting(const merlin_capture *capture)
{
    return capture ? capture->lighting : MERLIN_UNKNOWN_LIGHTS;
}

void merlin_capture_free(merlin_capture *capture)
{
    if (!capture) return;
    pst_capture_free(capture);
    free(capture);
}

/* ---- the surface ---- */

/* Converts lights that are listed relative to the object to the camera's space, in a list of their own. */
static status place_lights(merlin_capture *c, const merlin_stereo_params *params, merlin_light **own)
{
    const watch shown = {params->progress, params->progress_context, params->stop};
    const size_t size = (size_t)c->count * sizeof **own;
    *own = malloc(size);
    if (!*own) return fail(MERLIN_NO_MEMORY, "no memory for %d lights", c->count);
    memcpy(*own, c->light, size);
    c->light = *own;
    return pst_place_lights(c, &shown);
}

static status copy_names(const merlin_capture *c, merlin_surface *out)
{
    out->picture_names = calloc((size_t)c->count, sizeof *out->picture_names);
    for (int i = 0; out->picture_names && i < c->count; i++) {
        out->picture_names[i] = strdup(c->name[i]);
        if (!out->picture_names[i]) break;
    }
    bool all = out->picture_names && out->picture_names[c->count - 1];
    return all ? OK : fail(MERLIN_NO_MEMORY, "no memory for file names");
}

/* Takes over what reports say of the pictures. */
static status describe(const merlin_capture *c, const merlin_stereo_params *params, merlin_surface *out)
{
    out->picture_count = c->count;
    status s = copy_names(c, out);
    out->lights_in_order = c->lights_in_order;
    out->keep_edges = params->keep_edges != 0;
    for (size_t i = 0; i < c->skipped.count && s == OK; i++)
        s = skipped_add(&out->skipped, c->skipped.at[i].name, c->skipped.at[i].why);
    return s == OK ? surface_normal_error(out, c, &out->normal_error) : s;
}

/* Solves the capture; c: with a mask. */
static status solve(merlin_capture *c, const merlin_stereo_params *params, const pst_guide *guide, merlin_surface *out)
{
    const double began = clock_seconds();
    merlin_light *own = NULL;
    const merlin_stereo_method m = params->method;
    bool heeds_places = m == MERLIN_STEREO_AUTO || m == MERLIN_STEREO_NEAR || m == MERLIN_STEREO_NFPS;
    status s = c->about_object && heeds_places ? place_lights(c, params, &own) : OK;
    if (s == OK) s = pst_solve_guided(c, params, guide, out);
    const double solved = clock_seconds();
    if (s == OK) s = pst_surface_integrate(params, out);
    if (s == OK && !params->unchecked) s = pst_doubts(c, out, &out->warnings);
    if (s == OK) s = describe(c, params, out);
    free(own);
    const double ended = clock_seconds();
    out->seconds.read = c->seconds_read;
    out->seconds.solve = solved - began;
    out->seconds.integrate = ended - solved;
    out->seconds.total = c->seconds_read + ended - began;
    return s;
}

status pst_stereo_guided(const merlin_capture *capture, const merlin_stereo_params *params, const pst_guide *guide,
                         merlin_surface *out)
{
    static const merlin_stereo_params usual = {0};
    status s = OK;
    if (!params) params = &usual;
    if (params->method < MERLIN_STEREO_AUTO || params->method > MERLIN_STEREO_NFPS)
        s = fail(MERLIN_WRONG_USE, "no method of photometric stereo has the number %d", (int)params->method);
    if (s == OK && !capture->count) s = fail(MERLIN_WRONG_USE, "the capture has no pictures");
    if (s != OK) return s;
    merlin_capture c = *capture; /* borrows everything except for a mask that is found */
    bool search = !c.mask.data;
    if (search) s = pst_capture_find_mask(&c);
    if (s == OK) s = solve(&c, params, guide, out);
    if (search) img_free(&c.mask);
    if (s != OK) merlin_surface_free(out);
    return s;
}

merlin_status merlin_stereo(const merlin_capture *capture, const merlin_stereo_params *params, merlin_surface *out)
{
    if (out) *out = (merlin_surface){0};
    status s = api_needs(__func__, capture && out);
    return s == OK ? pst_stereo_guided(capture, params, NULL, out) : s;
}
