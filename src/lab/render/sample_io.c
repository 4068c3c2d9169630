/* SPDX-License-Identifier: MIT */
#include "lab/render/sample.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "image/exr/exr.h"

enum {
    MAX_CHANNELS = 32 + 6 * SAMPLE_MAX_TARGETS + 7 * SAMPLE_MAX_LAMPS,
    MAX_ATTRIBUTES = 18 + 3 * SAMPLE_MAX_TARGETS + 2 * SAMPLE_MAX_LAMPS,
    NAME_SIZE = 32
};

/* A layer's channels: one image and the suffixes of its channels' names. */
typedef struct layer {
    const char *name, *endings;
    size_t offset; /* of the img within the sample */
    enum {
        ALWAYS,
        LIT,  /* read by sample_read_training_environment, and by sample_read if the file has it */
        FULL, /* read only by sample_read, and only if the file has it */
    } when;
} layer;

static const layer layers[] = {
    {"albedo", "RGB", offsetof(sample, albedo), ALWAYS},     {"normal", "XYZ", offsetof(sample, normal), ALWAYS},
    {"roughness", "Y", offsetof(sample, roughness), ALWAYS}, {"depth", "Z", offsetof(sample, depth), ALWAYS},
    {"mask", "A", offsetof(sample, mask), ALWAYS},           {"direct", "RGB", offsetof(sample, direct), ALWAYS},
    {"indirect", "RGB", offsetof(sample, indirect), ALWAYS}, {"bounce2", "RGB", offsetof(sample, bounce2), FULL},
    {"bounce3", "RGB", offsetof(sample, bounce3), FULL},     {"env", "RGB", offsetof(sample, env), LIT},
};
enum { LAYER_COUNT = sizeof layers / sizeof *layers };

static img *layer_image(const sample *s, const layer *l)
{
    return (img *)((char *)(uintptr_t)s + l->offset);
}

/* Channels being collected; their names live as long as the list. */
typedef struct channel_list {
    char names[MAX_CHANNELS][NAME_SIZE];
    const img *image[MAX_CHANNELS];
    int part[MAX_CHANNELS];
    size_t count;
} channel_list;

static void add_layer(channel_list *list, const char *name, const char *endings, const img *image)
{
    for (int c = 0; endings[c]; c++) {
        snprintf(list->names[list->count], NAME_SIZE, "%.24s.%c", name, endings[c]);
        list->image[list->count] = image;
        list->part[list->count++] = c;
    }
}

static void add_targets(channel_list *list, const sample *s)
{
    char name[NAME_SIZE];
    for (int t = 0; t < s->target_count; t++) {
        snprintf(name, sizeof name, "target%02d.direct", t);
        add_layer(list, name, "RGB", &s->targets[t].direct);
        snprintf(name, sizeof name, "target%02d.indirect", t);
        add_layer(list, name, "RGB", &s->targets[t].indirect);
    }
}

static void add_lamps(channel_list *list, const sample *s)
{
    char name[NAME_SIZE];
    for (int i = 0; i < s->lamp_count; i++) {
        snprintf(name, sizeof name, "lamp%02d.direct", i);
        add_layer(list, name, "RGB", &s->lamps[i].direct);
        snprintf(name, sizeof name, "lamp%02d.indirect", i);
        add_layer(list, name, "RGB", &s->lamps[i].indirect);
        snprintf(name, sizeof name, "lamp%02d.visibility", i);
        add_layer(list, name, "Y", &s->lamps[i].visibility);
    }
}

void sample_free(sample *s)
{
    for (int i = 0; i < LAYER_COUNT; i++)
        img_free(layer_image(s, &layers[i]));
    for (int t = 0; t < s->target_count; t++) {
        img_free(&s->targets[t].direct);
        img_free(&s->targets[t].indirect);
    }
    free(s->targets);
    for (int i = 0; i < s->lamp_count; i++) {
        img_free(&s->lamps[i].direct);
        img_free(&s->lamps[i].indirect);
        img_free(&s->lamps[i].visibility);
    }
    free(s->lamps);
    *s = (sample){0};
}

/* ---- writing --------------------------------------------------------------------------------------------------- */

typedef struct attribute_list {
    exr_attribute items[MAX_ATTRIBUTES];
    char names[SAMPLE_MAX_TARGETS][3][NAME_SIZE], lamp_names[2 * SAMPLE_MAX_LAMPS][NAME_SIZE];
    char seed[24], index[24];
    size_t count;
} attribute_list;

static void add_numbers(attribute_list *list, const char *name, const float *values, int count)
{
    exr_attribute *a = &list->items[list->count++];
    *a = (exr_attribute){.name = name, .count = count};
    memcpy(a->values, values, (size_t)count * sizeof *values);
}

/* Describes targets' lights; of an LED, what makes it one, so that files without LEDs stay as before. */
static void describe_targets(attribute_list *list, const sample *s)
{
    list->items[list->count++] = exr_number("targets", (float)s->target_count);
    for (int t = 0; t < s->target_count; t++) {
        const sample_target *under = &s->targets[t];
        const float at[3] = {under->light.x, under->light.y, under->light.z};
        const float axis[3] = {under->axis.x, under->axis.y, under->axis.z};
        char(*names)[NAME_SIZE] = list->names[t];
        snprintf(names[0], NAME_SIZE, "target%02d.light", t);
        snprintf(names[1], NAME_SIZE, "target%02d.axis", t);
        snprintf(names[2], NAME_SIZE, "target%02d.lobe", t);
        add_numbers(list, names[0], at, 3);
        if (vec3_length(under->axis) > 0) add_numbers(list, names[1], axis, 3);
        if (under->lobe != 0) add_numbers(list, names[2], &under->lobe, 1);
    }
}

/* Describes lamps; without any nothing is written, so that files without lamps stay as before. */
static void describe_lamps(attribute_list *list, const sample *s)
{
    if (s->lamp_count) list->items[list->count++] = exr_number("lamps", (float)s->lamp_count);
    for (int i = 0; i < s->lamp_count; i++) {
        const sample_lamp *under = &s->lamps[i];
        const float at[3] = {under->at.x, under->at.y, under->at.z}, kind[2] = {under->distant, under->radius};
        char *at_name = list->lamp_names[2 * i], *kind_name = list->lamp_names[2 * i + 1];
        snprintf(at_name, NAME_SIZE, "lamp%02d.at", i);
        add_numbers(list, at_name, at, 3);
        snprintf(kind_name, NAME_SIZE, "lamp%02d.distantRadius", i);
        add_numbers(list, kind_name, kind, 2);
    }
}

static void describe(attribute_list *list, const sample *s)
{
    const float light[3] = {s->light.x, s->light.y, s->light.z}, slant[2] = {s->slant.right, s->slant.up};
    list->count = 0;
    add_numbers(list, "light", light, 3);
    add_numbers(list, "lightPower", &s->light_power, 1);
    add_numbers(list, "fieldOfView", &s->fov, 1);
    if (s->slant.right != 0 || s->slant.up != 0) add_numbers(list, "slant", slant, 2);
    if (s->env.data) add_numbers(list, "sphericalHarmonics", &s->sh[0][0], 27);
    /* 64-bit numbers as text: a float cannot hold them */
    snprintf(list->seed, sizeof list->seed, "%" PRIu64, s->seed);
    snprintf(list->index, sizeof list->index, "%" PRIu64, s->index);
    list->items[list->count++] = exr_text("seed", list->seed);
    list->items[list->count++] = exr_text("index", list->index);
    list->items[list->count++] = exr_text("shape", s->shape);
    list->items[list->count++] = exr_number("generatorVersion", (float)s->generator_version);
    describe_targets(list, s);
    describe_lamps(list, s);
}

status sample_write(const char *path, const sample *s)
{
    struct {
        channel_list channels;
        attribute_list attributes;
        exr_channel written[MAX_CHANNELS];
    } *work = malloc(sizeof *work);
    if (!work) return fail(MERLIN_NO_MEMORY, "out of memory to write %s", path);
    channel_list *list = &work->channels;
    list->count = 0;
    for (int i = 0; i < LAYER_COUNT; i++) {
        const img *image = layer_image(s, &layers[i]);
        if (image->data) add_layer(list, layers[i].name, layers[i].endings, image);
    }
    add_targets(list, s);
    add_lamps(list, s);
    for (size_t i = 0; i < list->count; i++)
        work->written[i] =
            (exr_channel){list->names[i], list->image[i]->data + list->part[i], list->image[i]->channels, false};
    describe(&work->attributes, s);
    status st = exr_write(path, s->albedo.width, s->albedo.height, work->written, list->count, work->attributes.items,
                          work->attributes.count);
    free(work);
    return st;
}

/* ---- reading --------------------------------------------------------------------------------------------------- */

static void read_identity(const exr_file *f, sample *s)
{
    const char *seed = exr_get_text(f, "seed"), *index = exr_get_text(f, "index"), *shape = exr_get_text(f, "shape");
    float version = 0;
    if (seed) s->seed = strtoull(seed, NULL, 10);
    if (index) s->index = strtoull(index, NULL, 10);
    if (shape) snprintf(s->shape, sizeof s->shape, "%s", shape);
    exr_get_numbers(f, "generatorVersion", &version, 1);
    if (version >= 0 && version < 1e6f) s->generator_version = (int)version;
}

/* Reads the attributes that give the images their meaning. */
static status read_optics(const exr_file *f, const char *path, sample *s)
{
    float light[3];
    if (!exr_get_numbers(f, "light", light, 3) || !exr_get_numbers(f, "lightPower", &s->light_power, 1) ||
        !exr_get_numbers(f, "fieldOfView", &s->fov, 1))
        return fail(MERLIN_BAD_INPUT, "%s: not a sample of this renderer (no light, lightPower or fieldOfView)", path);
    s->light = vec3_of(light);
    float slant[2] = {0, 0};
    exr_get_numbers(f, "slant", slant, 2);
    s->slant = (camera_slant){slant[0], slant[1]};
    if (!(slant[0] * slant[0] + slant[1] * slant[1] < 1))
        return fail(MERLIN_BAD_INPUT, "%s: impossible slant %g, %g", path, (double)slant[0], (double)slant[1]);
    if (!(s->fov > 0 && s->fov < 180) || !(s->light_power > 0))
        return fail(MERLIN_BAD_INPUT, "%s: impossible field of view %g or light power %g", path, (double)s->fov,
                    (double)s->light_power);
    return OK;
}

static status make_target(const exr_file *f, const char *path, int t, sample_target *under)
{
    char name[NAME_SIZE];
    float at[3], axis[3] = {0, 0, 0};
    snprintf(name, sizeof name, "target%02d.light", t);
    if (!exr_get_numbers(f, name, at, 3)) return fail(MERLIN_BAD_INPUT, "%s: attribute %s is missing", path, name);
    snprintf(name, sizeof name, "target%02d.axis", t);
    exr_get_numbers(f, name, axis, 3);
    snprintf(name, sizeof name, "target%02d.lobe", t);
    exr_get_numbers(f, name, &under->lobe, 1);
    under->light = vec3_of(at);
    under->axis = vec3_of(axis);
    float length = vec3_length(under->axis);
    if (!(under->lobe >= 0) || ((under->lobe > 0 || length > 0) && !(fabsf(length - 1) < 1e-3f)))
        return fail(MERLIN_BAD_INPUT, "%s: impossible lobe of exponent %g about an axis of length %g (target%02d)",
                    path, (double)under->lobe, (double)length, t);
    status s = img_new(&under->direct, exr_width(f), exr_height(f), 3);
    return s == OK ? img_new(&under->indirect, exr_width(f), exr_height(f), 3) : s;
}

static status make_targets(const exr_file *f, const char *path, sample *s)
{
    float count = 0;
    if (!exr_get_numbers(f, "targets", &count, 1) || count == 0) return OK;
    if (!(count > 0 && count <= SAMPLE_MAX_TARGETS))
        return fail(MERLIN_BAD_INPUT, "%s: impossible number of targets %g", path, (double)count);
    s->targets = calloc((size_t)count, sizeof *s->targets);
    if (!s->targets) return fail(MERLIN_NO_MEMORY, "out of memory to read %s", path);
    s->target_count = (int)count;
    status st = OK;
    for (int t = 0; t < s->target_count && st == OK; t++)
        st = make_target(f, path, t, &s->targets[t]);
    return st;
}

static status make_lamp(const exr_file *f, const char *path, int i, sample_lamp *under)
{
    char name[NAME_SIZE];
    float at[3], kind[2];
    snprintf(name, sizeof name, "lamp%02d.at", i);
    bool known = exr_get_numbers(f, name, at, 3);
    if (known) snprintf(name, sizeof name, "lamp%02d.distantRadius", i);
    if (!known || !exr_get_numbers(f, name, kind, 2))
        return fail(MERLIN_BAD_INPUT, "%s: attribute %s is missing", path, name);
    under->at = vec3_of(at);
    under->distant = kind[0] != 0;
    under->radius = kind[1];
    status s = img_new(&under->direct, exr_width(f), exr_height(f), 3);
    if (s == OK) s = img_new(&under->indirect, exr_width(f), exr_height(f), 3);
    return s == OK ? img_new(&under->visibility, exr_width(f), exr_height(f), 1) : s;
}

static status make_lamps(const exr_file *f, const char *path, sample *s)
{
    float count = 0;
    if (!exr_get_numbers(f, "lamps", &count, 1) || count == 0) return OK;
    if (!(count > 0 && count <= SAMPLE_MAX_LAMPS))
        return fail(MERLIN_BAD_INPUT, "%s: impossible number of lamps %g", path, (double)count);
    s->lamps = calloc((size_t)count, sizeof *s->lamps);
    if (!s->lamps) return fail(MERLIN_NO_MEMORY, "out of memory to read %s", path);
    s->lamp_count = (int)count;
    status st = OK;
    for (int i = 0; i < s->lamp_count && st == OK; i++)
        st = make_lamp(f, path, i, &s->lamps[i]);
    return st;
}

typedef enum extent { READ_TRAINING, READ_TRAINING_ENVIRONMENT, READ_ALL } extent;

static bool is_wanted(const exr_file *f, const layer *l, extent what)
{
    char first[NAME_SIZE];
    snprintf(first, sizeof first, "%s.%c", l->name, l->endings[0]);
    if (l->when == LIT && what == READ_TRAINING_ENVIRONMENT) return true;
    return l->when == ALWAYS || (what == READ_ALL && exr_has_channel(f, first));
}

/* Makes the images to be read and lists their channels. */
static status plan(const exr_file *f, const char *path, extent what, sample *s, channel_list *list)
{
    list->count = 0;
    for (int i = 0; i < LAYER_COUNT; i++) {
        if (!is_wanted(f, &layers[i], what)) continue;
        img *image = layer_image(s, &layers[i]);
        status st = img_new(image, exr_width(f), exr_height(f), (int)strlen(layers[i].endings));
        if (st != OK) return fail_in(st, "cannot read %s", path);
        add_layer(list, layers[i].name, layers[i].endings, image);
    }
    if (what != READ_ALL) return OK;
    status st = make_targets(f, path, s);
    if (st == OK) st = make_lamps(f, path, s);
    add_targets(list, s);
    add_lamps(list, s);
    return st;
}

static status check_finite(const char *path, const channel_list *list)
{
    for (size_t i = 0; i < list->count; i++) {
        const img *image = list->image[i];
        size_t pixels = (size_t)image->width * (size_t)image->height;
        for (size_t p = 0; p < pixels; p++)
            if (!isfinite(image->data[p * (size_t)image->channels + (size_t)list->part[i]]))
                return fail(MERLIN_BAD_INPUT, "%s: %s holds NaN or infinity at pixel %zu,%zu", path, list->names[i],
                            p % (size_t)image->width, p / (size_t)image->width);
    }
    return OK;
}

static status no_environment(const char *path)
{
    return fail(MERLIN_BAD_INPUT, "%s was rendered without environment: render samples without --no-env", path);
}

/* Reads the environment's coefficients; returns false and leaves sh alone if there is no environment image or no
 * coefficients. */
static bool read_environment(const exr_file *f, float sh[9][3])
{
    return exr_has_channel(f, "env.R") && exr_get_numbers(f, "sphericalHarmonics", &sh[0][0], 27);
}

static status read_open(exr_file *f, const char *path, extent what, sample *s)
{
    struct {
        channel_list channels;
        exr_target targets[MAX_CHANNELS];
    } *work = malloc(sizeof *work);
    if (!work) return fail(MERLIN_NO_MEMORY, "out of memory to read %s", path);
    channel_list *list = &work->channels;
    read_identity(f, s);
    bool lit = read_environment(f, s->sh);
    status st = read_optics(f, path, s);
    if (st == OK && what == READ_TRAINING_ENVIRONMENT && !lit) st = no_environment(path);
    if (st == OK) st = plan(f, path, what, s, list);
    if (st == OK) {
        for (size_t i = 0; i < list->count; i++)
            work->targets[i] =
                (exr_target){list->names[i], list->image[i]->data + list->part[i], list->image[i]->channels};
        st = exr_read(f, work->targets, list->count);
    }
    if (st == OK) st = check_finite(path, list);
    free(work);
    return st;
}

static status read_sample(const char *path, extent what, sample *out)
{
    exr_file *f;
    *out = (sample){0};
    status st = exr_open(path, &f);
    if (st != OK) return st;
    st = read_open(f, path, what, out);
    exr_close(f);
    if (st != OK) sample_free(out);
    return st;
}

status sample_read(const char *path, sample *out)
{
    return read_sample(path, READ_ALL, out);
}

status sample_read_training(const char *path, sample *out)
{
    return read_sample(path, READ_TRAINING, out);
}

status sample_read_training_environment(const char *path, sample *out)
{
    return read_sample(path, READ_TRAINING_ENVIRONMENT, out);
}

status sample_read_sh(const char *path, float sh[9][3])
{
    exr_file *f;
    status st = exr_open(path, &f);
    if (st != OK) return st;
    if (!read_environment(f, sh)) st = no_environment(path);
    exr_close(f);
    return st;
}

status sample_read_version(const char *path, int *version)
{
    exr_file *f;
    sample s = {0};
    status st = exr_open(path, &f);
    if (st != OK) return st;
    read_identity(f, &s);
    st = read_optics(f, path, &s);
    *version = s.generator_version;
    exr_close(f);
    return st;
}

status sample_list(const char *folder, char ***paths, size_t *count)
{
    static const char *const endings[] = {".exr", NULL};
    status s = file_list(folder, endings, paths, count);
    if (s != OK || *count > 0) return s;
    file_list_free(*paths, 0);
    *paths = NULL;
    return fail(MERLIN_BAD_INPUT, "%s holds no samples (*.exr); make some with merlin-lab render", folder);
}

char *sample_path(const char *folder, uint64_t index)
{
    char name[32];
    snprintf(name, sizeof name, "%06" PRIu64 ".exr", index);
    return file_join(folder, name);
}
