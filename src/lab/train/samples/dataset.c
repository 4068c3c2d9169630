/* SPDX-License-Identifier: MIT */
#include "lab/train/samples/dataset.h"

#include <math.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/half.h"
#include "lab/render/sample.h"
#include "model/model.h"
#include "optics/light.h"
#include "optics/orientation.h"

enum { VALUES = 15, VALUES_WITH_ENVIRONMENT = 18 };

/* A sample's pixels inside the outline, in reading order. */
typedef struct packed {
    uint32_t count;
    int lamp_count;
    train_lamp lamp[TRAIN_LAMPS];
    float fov;
    camera_slant slant;
    float sh[9][3];
    uint16_t data[]; /* `count` positions (two 16-bit words each: low, high), then count × values halves */
} packed;

struct train_dataset {
    train_dataset_options options;
    size_t values; /* values of a pixel, without the lamps' */
    size_t count, memory_limit;
    char **paths;
    _Atomic(packed *) *kept;
    atomic_size_t memory_used;
    int generator_version;
};

status train_dataset_open(const char *folder, const train_dataset_options *options, train_dataset **out)
{
    *out = NULL;
    train_dataset *d = calloc(1, sizeof *d);
    if (!d) return fail(MERLIN_NO_MEMORY, "out of memory opening %s", folder);
    d->options = *options;
    d->values = options->environment || options->lamps ? VALUES_WITH_ENVIRONMENT : VALUES;
    d->memory_limit = (size_t)(options->memory_gib * 0x1p30);
    status s = sample_list(folder, &d->paths, &d->count);
    if (s == OK) {
        d->kept = calloc(d->count, sizeof *d->kept);
        if (!d->kept) s = fail(MERLIN_NO_MEMORY, "out of memory opening %s", folder);
    }
    if (s == OK) s = sample_read_version(d->paths[0], &d->generator_version);
    if (s != OK) {
        train_dataset_close(d);
        return s;
    }
    *out = d;
    return OK;
}

void train_dataset_close(train_dataset *d)
{
    if (!d) return;
    if (d->kept)
        for (size_t i = 0; i < d->count; i++)
            free(d->kept[i]);
    free((void *)d->kept);
    if (d->paths) file_list_free(d->paths, d->count);
    free(d);
}

size_t train_dataset_count(const train_dataset *d)
{
    return d->count;
}

int train_dataset_generator_version(const train_dataset *d)
{
    return d->generator_version;
}

static uint16_t *put3(uint16_t *to, const float *from)
{
    for (int c = 0; c < 3; c++)
        *to++ = float_to_half(from[c]);
    return to;
}

static size_t packed_bytes(const train_dataset *d, size_t count, int lamps)
{
    return sizeof(packed) + count * (d->values + 2 + (size_t)lamps * TRAIN_LAMP_VALUES) * sizeof(uint16_t);
}

/* Stores light of all bounces, and its visibility. */
static uint16_t *put_lit(uint16_t *to, const img *direct, const img *indirect, float visibility, size_t i)
{
    float sum[3];
    for (size_t c = 0; c < 3; c++)
        sum[c] = fminf(direct->data[3 * i + c] + indirect->data[3 * i + c], 65504.0f); /* the largest half */
    to = put3(to, sum);
    *to++ = float_to_half(visibility);
    return to;
}

static uint16_t *put_lamp(const train_dataset *d, uint16_t *to, const sample *s, int k, size_t i)
{
    if (d->options.targets) return put_lit(to, &s->targets[k].direct, &s->targets[k].indirect, 1, i);
    const sample_lamp *l = &s->lamps[k];
    return put_lit(to, &l->direct, &l->indirect, l->visibility.data[i], i);
}

/* Returns how many of the sample's lamps, or targets, are kept. */
static int count_lamps(const train_dataset *d, const sample *s)
{
    const int count = d->options.targets ? s->target_count : d->options.lamps ? s->lamp_count : 0;
    return count < TRAIN_LAMPS ? count : TRAIN_LAMPS;
}

static void describe(const train_dataset *d, const sample *s, int lamps, packed *p)
{
    p->lamp_count = lamps;
    for (int k = 0; k < lamps; k++)
        p->lamp[k] = d->options.targets
                         ? (train_lamp){s->targets[k].light, false, s->targets[k].axis, s->targets[k].lobe}
                         : (train_lamp){s->lamps[k].at, s->lamps[k].distant, {0, 0, 0}, 0};
    p->fov = s->fov;
    p->slant = s->slant;
    memcpy(p->sh, s->sh, sizeof p->sh);
}

static packed *pack(const train_dataset *d, const sample *s)
{
    size_t count = 0, pixels = (size_t)s->mask.width * (size_t)s->mask.height;
    for (size_t i = 0; i < pixels; i++)
        count += s->mask.data[i] > 0;
    const int lamps = count_lamps(d, s);
    packed *p = calloc(1, packed_bytes(d, count, lamps));
    if (!p) return NULL;
    p->count = (uint32_t)count;
    describe(d, s, lamps, p);
    uint16_t *place = p->data, *value = p->data + 2 * count;
    for (size_t i = 0; i < pixels; i++) {
        if (!(s->mask.data[i] > 0)) continue;
        *place++ = (uint16_t)i;
        *place++ = (uint16_t)(i >> 16);
        value = put3(value, s->albedo.data + 3 * i);
        value = put3(value, s->normal.data + 3 * i);
        value = put3(value, s->direct.data + 3 * i);
        value = put3(value, s->indirect.data + 3 * i);
        *value++ = float_to_half(s->roughness.data[i]);
        *value++ = float_to_half(s->depth.data[i]);
        *value++ = float_to_half(s->mask.data[i]);
        if (d->values == VALUES_WITH_ENVIRONMENT) value = put3(value, s->env.data + 3 * i);
        for (int k = 0; k < lamps; k++)
            value = put_lamp(d, value, s, k, i);
    }
    return p;
}

/* Refuses samples of another camera or flash: the rendering layer assumes one of each, so that the shading of others
 * would be wrong everywhere. */
static status check_optics(const char *path, const sample *s, bool any_lens)
{
    if (!any_lens && fabsf(s->fov - CAMERA_FOV) > 0.01f)
        return fail(MERLIN_BAD_INPUT, "%s was rendered with a field of view of %g degrees, training wants %g", path,
                    (double)s->fov, (double)CAMERA_FOV);
    if (fabsf(s->light_power - LIGHT_POWER) > 0.001f * LIGHT_POWER)
        return fail(MERLIN_BAD_INPUT, "%s was rendered with a light of power %g, training wants %g", path,
                    (double)s->light_power, (double)LIGHT_POWER);
    if (!(vec3_length(s->light) <= 0.001f))
        return fail(MERLIN_BAD_INPUT, "%s was rendered with its light at %g, %g, %g, training wants it at the camera",
                    path, (double)s->light.x, (double)s->light.y, (double)s->light.z);
    return OK;
}

static status read_layers(const train_dataset *d, const char *path, sample *out)
{
    if (!d->options.lamps && !d->options.targets)
        return d->options.environment ? sample_read_training_environment(path, out) : sample_read_training(path, out);
    status s = sample_read(path, out);
    if (s != OK || (d->options.targets ? out->target_count > 0 : out->lamp_count > 0 && out->env.data)) return s;
    sample_free(out);
    if (d->options.targets)
        return fail(MERLIN_BAD_INPUT, "%s was rendered without targets: render samples with --targets or --leds", path);
    return fail(MERLIN_BAD_INPUT, "%s was rendered without lamps or without environment: render samples with --lamps",
                path);
}

static status read_packed(train_dataset *d, size_t i, packed **out)
{
    sample one;
    int size = d->options.size;
    status s = read_layers(d, d->paths[i], &one);
    if (s != OK) return s;
    if (one.mask.width != size || one.mask.height != size)
        s = fail(MERLIN_BAD_INPUT, "%s is %d×%d pixels, the training configuration wants %d×%d", d->paths[i],
                 one.mask.width, one.mask.height, size, size);
    else
        s = check_optics(d->paths[i], &one, d->options.lamps || d->options.targets);
    if (s == OK) {
        *out = pack(d, &one);
        if (!*out) s = fail(MERLIN_NO_MEMORY, "out of memory reading %s", d->paths[i]);
    }
    sample_free(&one);
    return s;
}

/* Keeps p if there is room. Returns true if the data set owns it now. */
static bool keep(train_dataset *d, size_t i, packed *p)
{
    size_t bytes = packed_bytes(d, p->count, p->lamp_count);
    if (atomic_fetch_add(&d->memory_used, bytes) + bytes > d->memory_limit) {
        atomic_fetch_sub(&d->memory_used, bytes);
        return false;
    }
    packed *nobody = NULL;
    if (atomic_compare_exchange_strong(&d->kept[i], &nobody, p)) return true;
    atomic_fetch_sub(&d->memory_used, bytes); /* another thread kept the sample first */
    return false;
}

static const uint16_t *get3(const uint16_t *from, float *to)
{
    for (int c = 0; c < 3; c++)
        to[c] = half_to_float(*from++);
    return from;
}

static void clear(const train_view *v, int lamps)
{
    size_t n = (size_t)v->size * (size_t)v->size;
    float *const three[] = {v->albedo, v->normal, v->direct, v->indirect};
    float *const one[] = {v->roughness, v->depth, v->mask};
    for (int i = 0; i < 4; i++)
        memset(three[i], 0, 3 * n * sizeof(float));
    if (v->env) memset(v->env, 0, 3 * n * sizeof(float));
    if (v->lamps) memset(v->lamps, 0, (size_t)lamps * TRAIN_LAMP_VALUES * n * sizeof(float));
    for (int i = 0; i < 3; i++)
        memset(one[i], 0, n * sizeof(float));
}

static const uint16_t *get_lamps(const uint16_t *from, int count, size_t pixels, float *pixel)
{
    for (int k = 0; k < count; k++, pixel += TRAIN_LAMP_VALUES * pixels)
        for (int c = 0; c < TRAIN_LAMP_VALUES; c++)
            pixel[c] = half_to_float(*from++);
    return from;
}

static void turn_vector(int orientation, vec3 *v)
{
    float values[3];
    vec3_put(*v, values);
    orientation_turn(orientation, values);
    *v = vec3_of(values);
}

/* Fills in what samples with lamps have besides pictures. */
static void unpack_lights(const packed *p, int orientation, train_view *v)
{
    vec3 slant = {p->slant.right, p->slant.up, 0};
    turn_vector(orientation, &slant);
    v->lens = (camera){v->size, v->size, p->fov, {slant.x, slant.y}};
    v->lamp_count = p->lamp_count;
    for (int k = 0; k < p->lamp_count; k++) {
        v->lamp[k] = p->lamp[k];
        turn_vector(orientation, &v->lamp[k].at);
        turn_vector(orientation, &v->lamp[k].axis);
    }
}

static void unpack(const packed *p, int orientation, train_view *v)
{
    const size_t pixels = (size_t)v->size * (size_t)v->size;
    clear(v, p->lamp_count);
    unpack_lights(p, orientation, v);
    const uint16_t *place = p->data, *value = p->data + 2 * (size_t)p->count;
    for (uint32_t k = 0; k < p->count; k++, place += 2) {
        size_t i = orientation_place(orientation, v->size, (size_t)place[0] | (size_t)place[1] << 16);
        value = get3(value, v->albedo + 3 * i);
        value = get3(value, v->normal + 3 * i);
        orientation_turn(orientation, v->normal + 3 * i);
        value = get3(value, v->direct + 3 * i);
        value = get3(value, v->indirect + 3 * i);
        v->roughness[i] = half_to_float(*value++);
        v->depth[i] = half_to_float(*value++);
        v->mask[i] = half_to_float(*value++);
        if (v->env) value = get3(value, v->env + 3 * i);
        if (v->lamps) value = get_lamps(value, p->lamp_count, pixels, v->lamps + TRAIN_LAMP_VALUES * i);
    }
    if (!v->sh) return;
    float sh[9][3];
    memcpy(sh, p->sh, sizeof sh);
    orientation_turn_sh(orientation, sh);
    memcpy(v->sh, sh, sizeof sh);
}

status train_dataset_sh(train_dataset *d, size_t i, int orientation, float sh[9][3])
{
    const packed *p = d->kept[i];
    status s = OK;
    if (p)
        memcpy(sh, p->sh, sizeof p->sh);
    else
        s = sample_read_sh(d->paths[i], sh);
    orientation_turn_sh(orientation, sh);
    return s;
}

status train_dataset_get(train_dataset *d, size_t i, int orientation, train_view *out)
{
    packed *p = d->kept[i];
    bool owned = true;
    if (!p) {
        status s = read_packed(d, i, &p);
        if (s != OK) return s;
        owned = keep(d, i, p);
    }
    unpack(p, orientation, out);
    if (!owned) free(p);
    return OK;
}
