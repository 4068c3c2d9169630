/* SPDX-License-Identifier: MIT */
#include "lab/eval/tables/lit_subject.h"

#include <math.h>
#include <stdlib.h>

#include "base/number.h"
#include "estimate/surface/exposure.h"
#include "image/color.h"
#include "lab/eval/metrics/metrics.h"
#include "lab/eval/samples/truth.h"

/* The 95th percentile of the object's luminance, as a share of white: what a camera's automatic exposure makes of it.
 */
static const float EXPOSED = 0.7f, BRIGHT_SHARE = 0.95f;

static status measure_sample(const sample *s, status (*measure)(void *context, const lit_subject *on), void *context)
{
    lit_subject on = {.s = s};
    status st = eval_binary_mask(&s->mask, &on.mask);
    if (st == OK) st = eval_truth(s, &on.mask, &on.truth);
    if (st == OK) st = measure(context, &on);
    img_free(&on.mask);
    surface_free(&on.truth);
    return st;
}

status lit_subject_measure(const char *path, status (*measure)(void *context, const lit_subject *on), void *context)
{
    sample s;
    status st = sample_read(path, &s);
    if (st != OK) return st;
    if (s.lamp_count == 0 || !s.env.data)
        st = fail(MERLIN_BAD_INPUT, "%s was rendered without lamps or without environment: render samples with --lamps",
                  path);
    if (st == OK) st = measure_sample(&s, measure, context);
    sample_free(&s);
    return st;
}

/* ---- the photograph ---- */

static float mean_luminance(const lit_subject *on, const img *a, const img *b)
{
    double sum = 0, count = 1e-6;
    for (size_t i = 0; i < img_value_count(&on->mask); i++) {
        if (on->mask.data[i] == 0) continue;
        sum += (double)(color_luminance(a->data + 3 * i) + (b ? color_luminance(b->data + 3 * i) : 0));
        count++;
    }
    return (float)(sum / count);
}

static void add(const img *layer, float weight, img *to)
{
    for (size_t i = 0; i < img_value_count(to); i++)
        to->data[i] += weight * layer->data[i];
}

static status bright_part(const lit_subject *on, const img *photo, float *out)
{
    size_t count = 0, pixels = img_value_count(&on->mask);
    float *values = malloc((pixels + 1) * sizeof *values);
    if (!values) return fail(MERLIN_NO_MEMORY, "no memory for a photograph's brightness");
    for (size_t i = 0; i < pixels; i++)
        if (on->mask.data[i] > 0) values[count++] = color_luminance(photo->data + 3 * i);
    qsort(values, count, sizeof *values, number_ascending);
    *out = count ? values[(size_t)(BRIGHT_SHARE * (float)(count - 1))] : 0;
    free(values);
    return OK;
}

static status mix(const lit_subject *on, const lit_mixture *m, img *out)
{
    const sample *s = on->s;
    float flash = mean_luminance(on, &s->direct, &s->indirect), room = mean_luminance(on, &s->env, NULL), main = flash;
    status st = img_new(out, s->mask.width, s->mask.height, 3);
    if (st != OK) return st;
    if (m->flash > 0) add(&s->direct, m->flash, out), add(&s->indirect, m->flash, out);
    if (m->lamp >= 0) {
        const sample_lamp *l = &s->lamps[m->lamp];
        add(&l->direct, 1, out), add(&l->indirect, 1, out);
        main = mean_luminance(on, &l->direct, &l->indirect);
    }
    if (m->room > 0) add(&s->env, room > 0 ? m->room * main / room : 0, out);
    return OK;
}

status lit_radiance(const lit_subject *on, const lit_mixture *m, img *out, float *white)
{
    float bright = 0;
    status s = mix(on, m, out);
    if (s == OK) s = bright_part(on, out, &bright);
    *white = EXPOSURE_WHITE;
    if (m->room > 0 || m->lamp >= 0) *white = bright > 0 ? bright / EXPOSED : 1;
    if (s != OK) img_free(out);
    return s;
}

/* ---- figures ---- */

const lit_words lit_figure_words[LIT_FIGURES] = {
    [LIT_ANGLE] = {"degrees", "normal_angle_degrees", 1},
    [LIT_ALBEDO] = {"albedo", "albedo_error", 100},
    [LIT_ALBEDO_FREE] = {"its scale free", "albedo_error_scale_free", 100},
    [LIT_ROUGHNESS] = {"roughness", "roughness_error", 100},
    [LIT_RELIEF] = {"relief", "relief_error", 100},
};

static double relief_error(const img *depth, const lit_subject *on)
{
    double sum = 0, squares = 0, count = 1e-9;
    for (size_t i = 0; i < img_value_count(depth); i++) {
        if (on->mask.data[i] == 0) continue;
        double e = (double)(depth->data[i] - on->truth.depth.data[i]);
        sum += e;
        squares += e * e;
        count++;
    }
    double mean = sum / count, width = 2 * (double)camera_tangent(on->s->fov);
    return sqrt(fmax(squares / count - mean * mean, 0)) / width;
}

void lit_figures_add(const surface *maps, const lit_subject *on, double sum[LIT_FIGURES])
{
    sum[LIT_ANGLE] += eval_angle(&maps->normal, &on->truth.normal, &on->mask);
    sum[LIT_ALBEDO] += EVAL_UNIT * eval_mse(&maps->albedo, &on->truth.albedo, &on->mask);
    sum[LIT_ALBEDO_FREE] += EVAL_UNIT * eval_mse_scale_free(&maps->albedo, &on->truth.albedo, &on->mask);
    sum[LIT_ROUGHNESS] += EVAL_UNIT * eval_mse(&maps->roughness, &on->truth.roughness, &on->mask);
    sum[LIT_RELIEF] += relief_error(&maps->depth, on);
}
