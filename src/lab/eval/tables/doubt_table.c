/* SPDX-License-Identifier: MIT */
#include "lab/eval/tables/doubt_table.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/number.h"
#include "estimate/photo/network.h"
#include "estimate/surface/exposure.h"
#include "image/color.h"
#include "lab/eval/samples/photograph.h"

static const float ROOM_SHARE = 0.15f, BRIGHT = 0.6f;
static const double LAMP_BEGINS = 25, LAMP_IS_FAR = 50;

status doubt_table_add(doubt_table *t, merlin_model *model, doubt_photo *photo)
{
    merlin_params params = merlin_params_default();
    merlin_maps maps = {0};
    params.size = NETWORK_SIZE; /* finer normals change no doubt */
    params.shot = photo->shot;
    light_cues cues;
    status s = estimate_with_cues(model, &photo->picture, &photo->object, &params, &cues, &maps);
    if (s != OK) return fail_in(s, "%s", photo->name);
    doubt_row *larger = realloc(t->row, (t->count + 1) * sizeof *larger);
    if (larger) {
        t->row = larger;
        doubt_row *row = &larger[t->count++];
        *row = (doubt_row){.kind = photo->kind, .cues = cues, .elsewhere = maps.light_elsewhere, .doubts = maps.doubts};
        snprintf(row->name, sizeof row->name, "%s", photo->name);
    }
    merlin_maps_free(&maps);
    return larger ? OK : fail(MERLIN_NO_MEMORY, "no memory for a table");
}

void doubt_table_free(doubt_table *t)
{
    free(t->row);
    *t = (doubt_table){0};
}

doubt_counts doubt_table_count(const doubt_table *t, doubt_kind kind)
{
    doubt_counts c = {0};
    for (size_t i = 0; i < t->count; i++) {
        const doubt_row *row = &t->row[i];
        if (row->kind != kind) continue;
        c.pictures++;
        c.light += (row->doubts & MERLIN_DOUBT_LIGHT_ELSEWHERE) != 0;
        c.any += row->doubts != 0;
    }
    return c;
}

/* ---- samples ---- */

/* The brightest of the object's luminances, but for a twentieth. */
static status bright_part(const img *picture, const img *mask, float *out)
{
    enum { BINS = 512 };
    size_t bins[BINS] = {0}, count = 0, seen = 0, pixels = img_value_count(mask);
    for (size_t i = 0; i < pixels; i++) {
        if (mask->data[i] < 0.5f) continue;
        float place = 16 * (log2f(fmaxf(color_luminance(picture->data + 3 * i), 1e-6f)) + 20);
        bins[(int)clamp(place, 0, BINS - 1)]++;
        count++;
    }
    int bin = 0;
    while (bin < BINS - 1 && (seen += bins[bin]) <= count * 95 / 100)
        bin++;
    *out = exp2f((float)bin / 16 - 20);
    return count ? OK : fail(MERLIN_BAD_INPUT, "a sample shows no object");
}

/* sum += scale · part, where there is a part. */
static void add_scaled(const img *part, float scale, img *sum)
{
    for (size_t i = 0; part->data && i < img_value_count(sum); i++)
        sum->data[i] += scale * part->data[i];
}

/* One picture of a sample: the sum of two, exposed so that its bright part is at `bright` of white, which cuts it off;
 * 0: as a flash's usual exposure. */
static status add_picture(doubt_table *t, merlin_model *model, const sample *s, const char *name, doubt_kind kind,
                          const img *sum, float bright)
{
    eval_photo taken = {0};
    float part = 1;
    status st = bright_part(sum, &s->mask, &part);
    if (st == OK) st = eval_photo_take(s, sum, &s->mask, bright > 0 ? part / bright : EXPOSURE_WHITE, &taken);
    if (st != OK) return st;
    doubt_photo photo = {.name = name, .kind = kind, .picture = taken.picture};
    const merlin_image mask = taken.mask;
    st = merlin_object_find(&photo.picture, &mask, NULL, &photo.object);
    if (st == OK) {
        taken.picture = (img){0};
        st = doubt_table_add(t, model, &photo);
    }
    eval_photo_free(&taken);
    return st;
}

static status add_flash(doubt_table *t, merlin_model *model, const sample *s, const char *name)
{
    img sum;
    float flash, room;
    status st = img_copy(&sum, &s->direct);
    if (st != OK) return st;
    add_scaled(&s->indirect, 1, &sum);
    st = add_picture(t, model, s, name, DOUBT_FLASH, &sum, 0);
    if (st == OK && s->env.data) {
        st = bright_part(&sum, &s->mask, &flash);
        if (st == OK) st = bright_part(&s->env, &s->mask, &room);
        if (st == OK) add_scaled(&s->env, ROOM_SHARE * flash / room, &sum);
        if (st == OK) st = add_picture(t, model, s, name, DOUBT_FLASH_ROOM, &sum, 0);
        if (st == OK) st = add_picture(t, model, s, name, DOUBT_ROOM, &s->env, BRIGHT);
    }
    img_free(&sum);
    return st;
}

/* Seen from the object, between lens and lamp. */
static double degrees_beside(vec3 light)
{
    vec3 from_object = vec3_add(light, vec3_make(0, 0, 1));
    double along = (double)from_object.z / fmax((double)vec3_length(from_object), 1e-9);
    return acos(fmin(fmax(along, -1), 1)) * 180 / 3.14159265358979;
}

static status add_lamp(doubt_table *t, merlin_model *model, const sample *s, const char *name, int target)
{
    const sample_target *under = &s->targets[target];
    double degrees = degrees_beside(under->light);
    img sum;
    if (degrees < LAMP_BEGINS) return OK;
    status st = img_copy(&sum, &under->direct);
    if (st != OK) return st;
    add_scaled(&under->indirect, 1, &sum);
    st = add_picture(t, model, s, name, degrees < LAMP_IS_FAR ? DOUBT_LAMP : DOUBT_LAMP_FAR, &sum, BRIGHT);
    img_free(&sum);
    return st;
}

status doubt_table_add_sample(doubt_table *t, merlin_model *model, const char *path)
{
    sample s;
    status st = sample_read(path, &s);
    if (st != OK) return st;
    const char *name = file_name_of(path);
    st = add_flash(t, model, &s, name);
    for (int i = 0; i < s.target_count && st == OK; i++)
        st = add_lamp(t, model, &s, name, i);
    sample_free(&s);
    return st;
}
