/* SPDX-License-Identifier: MIT */
/* merlin_maps_from_capture: an object in several photographs under lights that nobody knows. A network sees them
 * together; if photometric stereo with the network's normals as a prior explains the pictures, its normals, which are
 * finer, replace the network's. */
#include <math.h>
#include <stdlib.h>

#include "base/api_needs.h"
#include "estimate/photo/estimate.h"
#include "estimate/photo/model_pair.h"
#include "image/coverage.h"
#include "merlin/lights.h"
#include "photo_stereo/align_pictures.h"
#include "photo_stereo/further_light.h"
#include "photo_stereo/maps_from_capture.h"
#include "photo_stereo/prior_stereo.h"
#include "stereo/capture/capture.h"
#include "stereo/doubts/capture_doubts.h"

/* Largest number of pictures that the network sees, evenly chosen, and of its runs on one. */
enum { SEEN = 32, RUNS = 64 };

/* Mean to which pictures are scaled before their object is searched for; the share of a picture, and of its edge, from
 * which on what is brighter than the background has some of that with it. */
static const double usual_mean = 0.2, whole = 0.9, along_edge = 0.1;

/* The pictures that the network sees. */
typedef struct seen {
    const merlin_capture *capture;
    bool compares; /* a network compares them */
    int count, number[SEEN];
    float lights[SEEN][MODEL_LIGHTS];   /* of each, as the network sees them one by one */
    float compared[SEEN][MODEL_LIGHTS]; /* the same by a network that compares the pictures, if there is one */
} seen;

static seen choose(const merlin_capture *c)
{
    seen s = {.capture = c, .count = c->count < SEEN ? c->count : SEEN};
    for (int i = 0; i < s.count; i++)
        s.number[i] = (int)((long)i * c->count / s.count);
    return s;
}

static status photograph(const seen *s, int which, img *out)
{
    const merlin_capture *c = s->capture;
    const size_t pixels = (size_t)c->width * (size_t)c->height, channels = (size_t)c->channels;
    const pst_plane *from = &c->picture[s->number[which]];
    status st = img_new(out, c->width, c->height, 3);
    for (size_t i = 0; st == OK && i < pixels; i++)
        for (size_t ch = 0; ch < 3; ch++)
            out->data[3 * i + ch] = (float)pst_code(from, channels * i + (ch < channels ? ch : 0)) / 65535;
    return st;
}

static status take_further(void *context, int number, img *out)
{
    return photograph(context, number + 1, out);
}

static status check(const merlin_capture *c)
{
    if (c->count < 1) return fail(MERLIN_WRONG_USE, "the capture has no pictures");
    if (!c->mask.data || (c->mask.width == c->width && c->mask.height == c->height)) return OK;
    return fail(MERLIN_BAD_INPUT, "the mask is %d x %d pixels, the pictures are %d x %d", c->mask.width, c->mask.height,
                c->width, c->height);
}

/* ---- the object ---- */

static double mean_of(const img *picture)
{
    double sum = 0;
    const size_t count = img_value_count(picture);
    for (size_t i = 0; i < count; i++)
        sum += (double)picture->data[i];
    return sum / (double)count;
}

/* Averages the pictures, all as bright, which leaves little of their shadows. */
static status mean_picture(const seen *s, img *out)
{
    status st = img_new(out, s->capture->width, s->capture->height, 3);
    for (int k = 0; k < s->count && st == OK; k++) {
        img picture = {0};
        st = photograph(s, k, &picture);
        const double mean = st == OK ? mean_of(&picture) : 0;
        const float scale = mean > 0 ? (float)(usual_mean / (mean * s->count)) : 0;
        for (size_t i = 0; st == OK && i < img_value_count(out); i++)
            out->data[i] += scale * picture.data[i];
        img_free(&picture);
    }
    return st;
}

/* Tells whether a mask that was found by brightness tells the object from its background. */
static bool is_told_by_brightness(const img *mask)
{
    const double inside = (double)coverage_box_of(mask).pixels / (double)img_value_count(mask);
    return inside <= whole && (double)coverage_of_edge(mask) <= along_edge;
}

/* Searches for the object in all pictures. */
static status search_object(const seen *s, const merlin_hint *hint, merlin_object *out)
{
    img mean = {0};
    status st = mean_picture(s, &mean);
    if (st == OK) st = merlin_object_find(&mean, NULL, hint, out);
    img_free(&mean);
    return st;
}

/* Finds the object: by the capture's mask, else by what is brighter than a dark background, else by colours. */
static status find_object(const seen *s, const img *first, const merlin_hint *hint, merlin_object *out)
{
    const merlin_capture *c = s->capture;
    const bool hinted = hint->point_count > 0 || hint->box.width > 0;
    if (c->mask.data && !c->mask_found && hinted)
        return fail(MERLIN_WRONG_USE, "the capture has a mask, and a hint where its object is");
    if (!c->mask.data || (c->mask_found && (hinted || !is_told_by_brightness(&c->mask))))
        return search_object(s, hint, out);
    status st = merlin_object_find(first, &c->mask, NULL, out);
    if (c->mask_found) out->source = MERLIN_MASK_FOUND;
    return st;
}

/* ---- the maps ---- */

/* Gives the capture the lens that the caller, else EXIF knows, if it has none: by their lens pictures tell whether
 * their lights are near. */
static void find_lens(const merlin_params *params, merlin_capture *c)
{
    const float focal_35mm = params->shot.focal_35mm > 0 ? params->shot.focal_35mm : c->focal_35mm;
    const float distance = c->camera.distance;
    if (pinhole_is_near(&c->camera)) return;
    c->camera = pinhole_known(c->width, c->height, params->fov, focal_35mm);
    c->camera.distance = distance;
}

static status estimate(merlin_model *model, seen *s, const merlin_params *params, merlin_maps *maps)
{
    merlin_params p = *params;
    const estimate_further further = {.count = s->count - 1,
                                      .take = take_further,
                                      .context = s,
                                      .lights = s->lights,
                                      .compared = s->compares ? s->compared : NULL};
    img first = {0};
    merlin_object object = {0};
    while (p.views > 1 && p.views * s->count > RUNS)
        p.views--;
    const pinhole *lens = &s->capture->camera;
    if (!(p.fov > 0) && pinhole_is_near(lens)) p.fov = pinhole_field_of_view(lens, s->capture->width);
    p.hint.reduced = s->capture->reduced;
    status st = photograph(s, 0, &first);
    if (st == OK) st = find_object(s, &first, &p.hint, &object);
    if (st == OK) st = estimate_several(model, &first, &object, &p, &further, maps);
    if (st == OK) maps->photographs = s->count;
    merlin_object_free(&object);
    img_free(&first);
    return st;
}

/* Replaces what is doubted of one photograph's light: of several each may have another one. */
static void doubt_several(const seen *s, merlin_maps *maps)
{
    if (s->count < 2) return;
    maps->doubts &= ~(unsigned)(MERLIN_DOUBT_LIGHT_ELSEWHERE | MERLIN_DOUBT_NO_FLASH | MERLIN_DOUBT_LIGHT_BEHIND);
    maps->doubts |= MERLIN_DOUBT_NOT_REFINED;
}

/* Advises which light to add, by those that a network sees. */
static void advise(const seen *s, merlin_maps *maps)
{
    vec3 light[SEEN];
    for (int i = 0; i < s->count; i++)
        light[i] = vec3_of((s->compares ? s->compared : s->lights)[i] + MODEL_LIGHTS_LAMP);
    if (s->count > 1) vec3_put(further_light(light, s->count), maps->further_light);
}

static status refine(const seen *s, const merlin_params *params, merlin_maps *maps)
{
    const size_t count = (size_t)s->capture->count;
    vec3 *light = calloc(2 * count, sizeof *light), *compared = light + count;
    float *near = calloc(count, sizeof *near);
    status st = light && near ? OK : fail(MERLIN_NO_MEMORY, "no memory for %zu lights", count);
    for (int i = 0; i < s->count && st == OK; i++) {
        light[s->number[i]] = vec3_of(s->lights[i] + MODEL_LIGHTS_LAMP);
        compared[s->number[i]] = vec3_of(s->compared[i] + MODEL_LIGHTS_LAMP);
        near[s->number[i]] = s->compared[i][MODEL_LIGHTS_DISTANCE];
    }
    /* a start from lights of which some are unknown would be a wrong one */
    const bool all_known = s->compares && s->count == s->capture->count;
    const prior_stereo how = {
        s->capture, {light, all_known ? compared : NULL, near}, params->near_network, params->stop};
    if (st == OK) st = prior_stereo_refine(&how, maps);
    free(light);
    free(near);
    return st;
}

static const char *name_of(const merlin_capture *c, int picture)
{
    return c->name && c->name[picture] ? c->name[picture] : "one";
}

static void note_shifts(const merlin_capture *c, const picture_shifts *shifts, warnings *out)
{
    if (shifts->moved)
        warnings_add(out, "pictures_moved",
                     "the camera moved: %d of %d pictures were shifted back, %s most, by %d pixels; keep it still",
                     shifts->moved, c->count, name_of(c, shifts->which), shifts->most);
}

/* Notes what the pictures and their files tell against the maps. */
static status note_pictures(const merlin_capture *c, const picture_shifts *shifts, merlin_maps *maps)
{
    maps->noticed = calloc(1, sizeof *maps->noticed);
    if (!maps->noticed) return fail(MERLIN_NO_MEMORY, "no memory for warnings");
    status s = pst_doubt_pictures(c, maps->noticed);
    note_shifts(c, shifts, maps->noticed);
    skipped_warn(&c->skipped, maps->noticed);
    return s;
}

/* Returns the position of the light that a network tells: `far` camera distances from the object's middle at most. */
static vec3 place_of(const merlin_maps *maps, const float told[MODEL_LIGHTS], float distance)
{
    static const float far = 5;
    const vec3 toward = vec3_normalize(vec3_of(told + MODEL_LIGHTS_LAMP));
    float place[3];
    vec3_put(
        vec3_scale(vec3_fma(vec3_make(0, 0, -1), 1 / fmaxf(told[MODEL_LIGHTS_DISTANCE], 1 / far), toward), distance),
        place);
    merlin_maps_lens_place(maps, place, place);
    return vec3_of(place);
}

status lights_of_capture(merlin_model *model, const merlin_capture *capture, int (*stop)(void), merlin_light *lights)
{
    seen pictures = choose(capture);
    pictures.compares = model->several != NULL;
    if (!pictures.compares) return fail(MERLIN_WRONG_USE, "the model tells no lights by comparing pictures");
    if (pictures.count < capture->count)
        return fail(MERLIN_WRONG_USE, "the lights of %d pictures are told at once, not of %d", SEEN, capture->count);
    merlin_params params = merlin_params_default();
    merlin_maps maps = {0};
    params.stop = stop;
    params.views = 1;
    status s = estimate(model, &pictures, &params, &maps);
    const float distance = capture->camera.distance > 0 ? capture->camera.distance : 1;
    for (int i = 0; i < pictures.count && s == OK; i++)
        vec3_put(place_of(&maps, pictures.compared[i], distance), lights[i].position);
    merlin_maps_free(&maps);
    return s;
}

merlin_status merlin_maps_from_capture(merlin_model *model, const merlin_capture *capture, const merlin_params *params,
                                       merlin_maps *maps)
{
    const merlin_params usual = merlin_params_default();
    if (maps) *maps = (merlin_maps){0};
    status s = api_needs(__func__, model && capture && maps);
    return s == OK ? maps_of_capture(model, capture, params ? params : &usual, true, maps) : s;
}

/* Makes maps of pictures that lie alike. */
static status maps_of_aligned(merlin_model *model, const merlin_capture *capture, const merlin_params *params,
                              bool refined, merlin_maps *maps)
{
    seen pictures = choose(capture);
    pictures.compares = model->several != NULL;
    status s = estimate(model, &pictures, params, maps);
    if (s == OK) doubt_several(&pictures, maps);
    if (s == OK) advise(&pictures, maps);
    if (s == OK && refined) s = refine(&pictures, params, maps);
    return s;
}

status maps_of_capture(merlin_model *model, const merlin_capture *capture, const merlin_params *params, bool refined,
                       merlin_maps *maps)
{
    merlin_capture aligned = {0};
    picture_shifts shifts;
    *maps = (merlin_maps){0};
    status s = check(capture);
    if (s != OK) return s;
    s = align_pictures(capture, &aligned, &shifts);
    if (s == OK) find_lens(params, &aligned);
    if (s == OK) s = maps_of_aligned(model, &aligned, params, refined, maps);
    if (s == OK) s = note_pictures(capture, &shifts, maps);
    align_pictures_free(capture, &aligned);
    if (s != OK) merlin_maps_free(maps);
    return s;
}
