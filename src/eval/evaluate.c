#include "eval/evaluate.h"

#include <math.h>
#include <string.h>

#include "base/file.h"
#include "base/progress.h"
#include "estimate/shadow.h"
#include "eval/metrics.h"
#include "eval/predict.h"
#include "eval/sheet.h"
#include "eval/trivial.h"

/* What one evaluation keeps from sample to sample. */
typedef struct evaluation {
    const eval_options *options;
    eval_model *model;
    eval_means means;
    eval_prediction prediction;
    eval_sheet *sheet; /* NULL: no picture wanted */
    eval_report *report;
} evaluation;

/* One sample on its way through. */
typedef struct subject {
    const sample *sample;
    img mask;  /* binary */
    img image; /* the network's input before encoding */
    eval_maps truth, inflated;
    eval_scores scores;
} subject;

/* Pictures of one relighting: up to EVAL_LIGHTS lights and their targets. */
typedef struct relighting {
    vec3 lights[EVAL_LIGHTS];
    img targets[EVAL_LIGHTS];
    int count;
    bool traced;
} relighting;

double eval_score(const eval_scores *scores, eval_row row, eval_answer answer)
{
    size_t count = scores->count[row][answer];
    return count ? scores->sum[row][answer] / (double)count : NAN;
}

double eval_best_trivial(const eval_scores *scores, eval_row row)
{
    double best = NAN;
    for (int answer = EVAL_MEAN; answer <= EVAL_UNCHANGED; answer++) {
        double score = eval_score(scores, row, (eval_answer)answer);
        best = row >= EVAL_RECONSTRUCTION ? fmax(best, score) : fmin(best, score);
    }
    return best;
}

static void note(eval_scores *scores, eval_row row, eval_answer answer, double value)
{
    scores->sum[row][answer] += value;
    scores->count[row][answer]++;
}

static status note_similarity(eval_scores *scores, eval_row row, eval_answer answer, const img *image,
                              const img *target)
{
    double similarity = 0;
    status s = eval_ssim(image, target, &similarity);
    if (s == OK) note(scores, row, answer, similarity);
    return s;
}

static void add_scores(eval_scores *to, const eval_scores *from)
{
    for (int row = 0; row < EVAL_ROWS; row++) {
        for (int answer = 0; answer < EVAL_ANSWERS; answer++) {
            to->sum[row][answer] += from->sum[row][answer];
            to->count[row][answer] += from->count[row][answer];
        }
    }
    to->samples++;
}

static void score_maps(subject *on, const eval_maps *maps, eval_answer answer)
{
    const img *mask = &on->mask;
    note(&on->scores, EVAL_ALBEDO, answer, eval_mse(&maps->albedo, &on->truth.albedo, mask));
    note(&on->scores, EVAL_NORMAL, answer, eval_mse(&maps->normal, &on->truth.normal, mask));
    note(&on->scores, EVAL_ANGLE, answer, eval_angle(&maps->normal, &on->truth.normal, mask));
    note(&on->scores, EVAL_DEPTH, answer, eval_mse(&maps->depth, &on->truth.depth, mask));
    note(&on->scores, EVAL_ROUGHNESS, answer, eval_mse(&maps->roughness, &on->truth.roughness, mask));
}

/* A trivial answer's picture is its maps rendered. */
static status score_trivial_picture(subject *on, const eval_maps *maps, eval_answer answer, eval_row row, vec3 light,
                                    const img *target)
{
    img lit;
    const sample *s = on->sample;
    status st = eval_render(maps, &on->mask, s->fov, s->light_power, light, &lit);
    if (st != OK) return st;
    st = note_similarity(&on->scores, row, answer, &lit, target);
    img_free(&lit);
    return st;
}

static status score_reconstruction(evaluation *e, subject *on)
{
    vec3 flash = on->sample->light;
    status s = note_similarity(&on->scores, EVAL_RECONSTRUCTION, EVAL_MODEL, &e->prediction.reconstruction, &on->image);
    if (s == OK) s = score_trivial_picture(on, &e->means.maps, EVAL_MEAN, EVAL_RECONSTRUCTION, flash, &on->image);
    if (s == OK) s = score_trivial_picture(on, &on->inflated, EVAL_INFLATED, EVAL_RECONSTRUCTION, flash, &on->image);
    return s;
}

/* The trivial answers relight by rendering alone, so all of the model's ways are held against the same figures. */
static void repeat_trivial(eval_scores *scores, eval_row from, eval_row to)
{
    for (int answer = EVAL_MEAN; answer <= EVAL_UNCHANGED; answer++) {
        scores->sum[to][answer] = scores->sum[from][answer];
        scores->count[to][answer] = scores->count[from][answer];
    }
}

static status score_relighting(evaluation *e, subject *on, const relighting *r)
{
    eval_row network = r->traced ? EVAL_TRACED_NETWORK : EVAL_RELIT_NETWORK;
    eval_row brdf = r->traced ? EVAL_TRACED_BRDF : EVAL_RELIT_BRDF;
    const img *by_network = r->traced ? e->prediction.full_by_network : e->prediction.by_network;
    const img *by_brdf = r->traced ? e->prediction.full_by_brdf : e->prediction.by_brdf;
    status s = OK;
    for (int i = 0; s == OK && i < r->count; i++) {
        const img *target = &r->targets[i];
        if (eval_model_relights(e->model))
            s = note_similarity(&on->scores, network, EVAL_MODEL, &by_network[i], target);
        if (s == OK) s = note_similarity(&on->scores, brdf, EVAL_MODEL, &by_brdf[i], target);
        if (s == OK) s = score_trivial_picture(on, &e->means.maps, EVAL_MEAN, brdf, r->lights[i], target);
        if (s == OK) s = score_trivial_picture(on, &on->inflated, EVAL_INFLATED, brdf, r->lights[i], target);
        if (s == OK) s = note_similarity(&on->scores, brdf, EVAL_UNCHANGED, &on->image, target);
    }
    repeat_trivial(&on->scores, brdf, network);
    return s;
}

static void relighting_free(relighting *r)
{
    for (int i = 0; i < EVAL_LIGHTS; i++)
        img_free(&r->targets[i]);
}

static status relight_by_brdf(const subject *on, relighting *r)
{
    const sample *s = on->sample;
    *r = (relighting){.count = EVAL_LIGHTS};
    for (int i = 0; i < EVAL_LIGHTS; i++) {
        r->lights[i] = eval_light(s, i);
        status st = eval_render(&on->truth, &on->mask, s->fov, s->light_power, r->lights[i], &r->targets[i]);
        if (st != OK) {
            relighting_free(r);
            return st;
        }
    }
    return OK;
}

/* The sample's path-traced targets from `first` on; a last group that is not full repeats its first light. */
static status relight_by_tracing(const subject *on, int first, relighting *r)
{
    const sample *s = on->sample;
    int left = s->target_count - first;
    *r = (relighting){.count = left < EVAL_LIGHTS ? left : EVAL_LIGHTS, .traced = true};
    for (int i = 0; i < EVAL_LIGHTS; i++) {
        const sample_target *target = &s->targets[first + (i < r->count ? i : 0)];
        r->lights[i] = target->light;
        status st = i < r->count ? eval_picture(&target->direct, &target->indirect, &on->mask, &r->targets[i]) : OK;
        if (st != OK) {
            relighting_free(r);
            return st;
        }
    }
    return OK;
}

static status score_brdf_targets(evaluation *e, subject *on)
{
    relighting r;
    status s = relight_by_brdf(on, &r);
    if (s != OK) return s;
    s = eval_predict(e->model, &on->image, &on->mask, r.lights, &e->prediction);
    if (s == OK) {
        score_maps(on, &e->prediction.maps, EVAL_MODEL);
        score_maps(on, &e->means.maps, EVAL_MEAN);
        score_maps(on, &on->inflated, EVAL_INFLATED);
        s = score_reconstruction(e, on);
    }
    if (s == OK) s = score_relighting(e, on, &r);
    if (s == OK && e->sheet)
        s = eval_sheet_add(e->sheet, &on->image, &on->mask, &on->truth, &e->prediction, &r.targets[0]);
    relighting_free(&r);
    return s;
}

/* The true maps under one light with the true indirect light: what relighting by BRDF itself leaves out. */
static status score_true_maps(subject *on, const sample_target *t, const shadow_caster *caster, const img *target)
{
    const sample *s = on->sample;
    const eval_row rows[] = {EVAL_TRACED_BRDF, EVAL_TRACED_SHADOWS};
    img lit = {0}, seen = {0};
    status st = eval_render(&on->truth, &on->mask, s->fov, s->light_power, t->light, &lit);
    if (st == OK) st = shadow_cast(caster, t->light, lit.width, lit.height, &seen);
    for (int i = 0; st == OK && i < 2; i++) {
        img full = {0};
        if (i == 1) shadow_darken(&seen, &lit);
        st = eval_picture(&lit, &t->indirect, &on->mask, &full);
        if (st == OK) st = note_similarity(&on->scores, rows[i], EVAL_TRUE_MAPS, &full, target);
        img_free(&full);
    }
    img_free(&lit);
    img_free(&seen);
    return st;
}

static status score_shadows(evaluation *e, subject *on, int first, const relighting *r)
{
    const eval_maps *truth = &on->truth;
    shadow_caster caster;
    status s = eval_predict_shadows(e->model, &on->mask, on->sample->fov, r->lights, &e->prediction);
    if (s == OK) s = shadow_caster_new(&truth->depth, &truth->normal, &on->mask, on->sample->fov, &caster);
    if (s != OK) return s;
    for (int i = 0; s == OK && i < r->count; i++) {
        const img *target = &r->targets[i];
        s = note_similarity(&on->scores, EVAL_TRACED_SHADOWS, EVAL_MODEL, &e->prediction.shadowed[i], target);
        if (s == OK) s = score_true_maps(on, &on->sample->targets[first + i], &caster, target);
    }
    repeat_trivial(&on->scores, EVAL_TRACED_BRDF, EVAL_TRACED_SHADOWS);
    shadow_caster_free(&caster);
    return s;
}

static status score_traced_targets(evaluation *e, subject *on)
{
    status s = OK;
    for (int first = 0; s == OK && first < on->sample->target_count; first += EVAL_LIGHTS) {
        relighting r;
        s = relight_by_tracing(on, first, &r);
        if (s != OK) return s;
        s = eval_predict(e->model, &on->image, &on->mask, r.lights, &e->prediction);
        if (s == OK) s = score_relighting(e, on, &r);
        if (s == OK) s = score_shadows(e, on, first, &r);
        relighting_free(&r);
    }
    return s;
}

/* The middle, by the logarithm, of what training adds of a sample's environment. */
static const float ENVIRONMENT_STRENGTH = 0.316f;

/* What the network is shown: the flash picture, for models of setting B in the sample's environment. */
static status take_photograph(const evaluation *e, subject *on)
{
    const sample *s = on->sample;
    const model_config *config = eval_model_config(e->model);
    img more = {0};
    if (config->lighting != MODEL_LIGHT_BOTH)
        return eval_picture(&s->direct, config->input_global ? &s->indirect : NULL, &on->mask, &on->image);
    if (!s->env.data)
        return fail(ERROR_INPUT, "model \"%s\" is for photographs in surroundings: render samples without --no-env",
                    config->name);
    status st = img_copy(&more, &s->env);
    if (st != OK) return st;
    for (size_t i = 0, n = 3 * (size_t)more.width * (size_t)more.height; i < n; i++)
        more.data[i] = ENVIRONMENT_STRENGTH * more.data[i] + (config->input_global ? s->indirect.data[i] : 0);
    st = eval_picture(&s->direct, &more, &on->mask, &on->image);
    img_free(&more);
    return st;
}

static status score_sample(evaluation *e, const sample *s, eval_scores *scores)
{
    subject on = {.sample = s};
    status st = eval_binary_mask(&s->mask, &on.mask);
    if (st == OK) st = take_photograph(e, &on);
    if (st == OK) st = eval_maps_of_sample(s, &on.truth);
    if (st == OK) st = eval_inflate(&on.image, &on.mask, &e->means, s->fov, s->light_power, &on.inflated);
    if (st == OK) st = score_brdf_targets(e, &on);
    if (st == OK) st = score_traced_targets(e, &on);
    *scores = on.scores;
    eval_maps_free(&on.truth);
    eval_maps_free(&on.inflated);
    img_free(&on.image);
    img_free(&on.mask);
    return st;
}

static status count_sample(eval_report *report, const sample *s, const eval_scores *scores)
{
    int c = 0;
    while (c < report->class_count && strcmp(report->class_names[c], s->shape) != 0)
        c++;
    if (c == EVAL_MAX_CLASSES) return fail(ERROR_INPUT, "more than %d classes of shape", EVAL_MAX_CLASSES);
    if (c == report->class_count) {
        memcpy(report->class_names[c], s->shape, sizeof report->class_names[c]);
        report->class_count++;
    }
    add_scores(&report->classes[c], scores);
    add_scores(&report->all, scores);
    return OK;
}

static status evaluate_file(evaluation *e, const char *path)
{
    sample s;
    status st = sample_read(path, &s);
    if (st != OK) return st;
    eval_scores scores = {0};
    if (s.mask.width != e->report->size || s.mask.height != e->report->size)
        st = fail(ERROR_INPUT, "%s is %dx%d but the first sample is %dx%d", path, s.mask.width, s.mask.height,
                  e->report->size, e->report->size);
    if (st == OK) st = score_sample(e, &s, &scores);
    if (st == OK) st = count_sample(e->report, &s, &scores);
    sample_free(&s);
    return st;
}

/* The size of all samples is that of the first. */
static status begin(evaluation *e, const char *first_path)
{
    const eval_options *o = e->options;
    sample first;
    status s = sample_read_training(first_path, &first);
    if (s != OK) return s;
    e->report->size = first.mask.width;
    sample_free(&first);
    s = eval_model_open(o->weights, e->report->size, o->type, &e->model);
    if (s == OK) s = eval_prediction_new(e->model, &e->prediction);
    if (s == OK && o->figure) s = eval_sheet_new(o->figure_rows, &e->sheet);
    if (s != OK) return s;
    e->report->means_from_data = !o->means;
    if (o->means)
        s = eval_means_read(o->means, e->report->size, e->report->size, &e->means);
    else
        s = eval_means_of_folder(o->data, o->count, o->quiet, &e->means);
    e->report->means_samples = e->means.samples;
    memcpy(e->report->model, eval_model_config(e->model)->name, sizeof e->report->model);
    return s;
}

static status evaluate_files(evaluation *e, char **names, size_t count)
{
    progress p;
    status s = OK;
    progress_begin(&p, "evaluating", "samples", 0, count, e->options->quiet);
    for (size_t i = 0; s == OK && i < count; i++) {
        if (e->options->stopped && e->options->stopped())
            s = fail(ERROR_STOPPED, "stopped after %zu of %zu samples", i, count);
        else
            s = evaluate_file(e, names[i]);
        if (s == OK) progress_update(&p, i + 1, NULL);
    }
    progress_end(&p);
    return s;
}

status eval_run(const eval_options *options, eval_report *out)
{
    *out = (eval_report){0};
    evaluation e = {.options = options, .report = out};
    double started = clock_seconds();
    char **names;
    size_t count;
    status s = file_list(options->data, (const char *const[]){".exr", NULL}, &names, &count);
    if (s != OK) return s;
    if (!count) s = fail(ERROR_INPUT, "%s holds no samples (*.exr); make some with merlin render", options->data);
    size_t used = options->count && options->count < count ? options->count : count;
    if (s == OK) s = begin(&e, names[0]);
    if (s == OK) s = evaluate_files(&e, names, used);
    if (s == OK && e.sheet) s = eval_sheet_write(e.sheet, options->figure);
    out->seconds = clock_seconds() - started;
    eval_sheet_free(e.sheet);
    eval_prediction_free(&e.prediction);
    eval_means_free(&e.means);
    eval_model_close(e.model);
    file_list_free(names, count);
    return s;
}
