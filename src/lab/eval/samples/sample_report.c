/* SPDX-License-Identifier: MIT */
#include "lab/eval/samples/sample_report.h"

#include <cjson/cJSON.h>
#include <math.h>
#include <string.h>

#include "base/json/json_put.h"
#include "base/text/report.h"

typedef struct row_text {
    const char *key, *label;
    double scale; /* as printed for a person: the paper's tables give errors times 100 */
    eval_goal_kind kind;
    double goal;
    double paper; /* MERLiN's figure in the paper, in the row's own unit; 0: none */
} row_text;

static const row_text rows[EVAL_ROWS] = {
    [EVAL_ALBEDO] = {"albedo", "albedo error (1e-2)", 100, EVAL_RATIO_AT_MOST, 0.6, 0.03787},
    [EVAL_NORMAL] = {"normal", "normal error (1e-2)", 100, EVAL_RATIO_AT_MOST, 0.6, 0.03311},
    [EVAL_ANGLE] = {"normal_degrees", "normal angle (degrees)", 1, EVAL_NO_GOAL, 0, 0},
    [EVAL_DEPTH] = {"depth", "depth error (1e-2)", 100, EVAL_RATIO_AT_MOST, 0.6, 0.00975},
    [EVAL_ROUGHNESS] = {"roughness", "roughness error (1e-2)", 100, EVAL_RATIO_AT_MOST, 0.8, 0.08267},
    [EVAL_SURROUNDINGS] = {"surroundings", "surroundings error (1e-2)", 100, EVAL_NO_GOAL, 0, 0},
    [EVAL_RECONSTRUCTION] = {"reconstruction_ssim", "reconstruction SSIM", 1, EVAL_AT_LEAST, 0.90, 0},
    [EVAL_RELIT_NETWORK] = {"relight_network_ssim", "relit by network, SSIM", 1, EVAL_MARGIN_AT_LEAST, 0.05, 0.819},
    [EVAL_RELIT_BRDF] = {"relight_brdf_ssim", "relit by BRDF, SSIM", 1, EVAL_MARGIN_AT_LEAST, 0.05, 0.894},
    [EVAL_BOTH_NETWORK] = {"both_lights_network_ssim", "both lights, by network", 1, EVAL_NO_GOAL, 0, 0},
    [EVAL_BOTH_BRDF] = {"both_lights_brdf_ssim", "both lights, by BRDF", 1, EVAL_NO_GOAL, 0, 0},
    [EVAL_TRACED_NETWORK] = {"traced_network_ssim", "path traced, by network", 1, EVAL_NO_GOAL, 0, 0},
    [EVAL_TRACED_BRDF] = {"traced_brdf_ssim", "path traced, by BRDF", 1, EVAL_NO_GOAL, 0, 0},
    [EVAL_TRACED_SHADOWS] = {"traced_shadows_ssim", "  and cast shadows", 1, EVAL_NO_GOAL, 0, 0},
    [EVAL_ENVIRONMENT_BRDF] = {"environment_brdf_ssim", "environment, by BRDF", 1, EVAL_NO_GOAL, 0, 0},
    [EVAL_ENVIRONMENT_SHADOWS] = {"environment_shadows_ssim", "  and cast shadows", 1, EVAL_NO_GOAL, 0, 0},
};

static const char *const answers[EVAL_ANSWERS] = {"model", "mean_maps", "inflated", "unchanged", "true_maps"};

eval_verdict eval_check_goal(const eval_scores *scores, eval_row row)
{
    double model = eval_score(scores, row, EVAL_MODEL), trivial = eval_best_trivial(scores, row);
    bool similarity = row >= EVAL_RECONSTRUCTION;
    eval_verdict v = {.kind = rows[row].kind,
                      .goal = rows[row].goal,
                      .ratio = !similarity && trivial > 0 ? model / trivial : NAN,
                      .margin = similarity ? model - trivial : NAN};
    if (v.kind == EVAL_RATIO_AT_MOST) v.holds = v.ratio <= v.goal;
    if (v.kind == EVAL_AT_LEAST) v.holds = model >= v.goal;
    if (v.kind == EVAL_MARGIN_AT_LEAST) v.holds = v.margin >= v.goal;
    return v;
}

static void print_number(FILE *stream, double value, const char *format)
{
    if (isnan(value))
        fprintf(stream, "%10s", "-");
    else
        fprintf(stream, format, value);
}

static void print_score(FILE *stream, const eval_scores *scores, eval_row row, eval_answer answer)
{
    print_number(stream, rows[row].scale * eval_score(scores, row, answer), "%10.4f");
}

static void print_goal(FILE *stream, const eval_verdict *v)
{
    static const char *const relations[] = {"", "ratio <= %.2f", "SSIM >= %.2f", "best + %.2f"};
    char text[32] = "";
    if (v->kind != EVAL_NO_GOAL) snprintf(text, sizeof text, relations[v->kind], v->goal);
    fprintf(stream, "   %-14s %s\n", text, v->kind == EVAL_NO_GOAL ? "" : v->holds ? "yes" : "no");
}

static void print_rows(const eval_scores *scores, FILE *stream)
{
    fprintf(stream, "%-26s%10s%10s%10s%10s%10s%10s%10s   %-14s %s\n", "", "model", "paper", "true maps", "mean maps",
            "inflated", "unchanged", "vs best", "goal", "holds");
    for (int row = 0; row < EVAL_ROWS; row++) {
        if (isnan(eval_best_trivial(scores, (eval_row)row))) continue;
        fprintf(stream, "%-26s", rows[row].label);
        print_score(stream, scores, (eval_row)row, EVAL_MODEL);
        print_number(stream, rows[row].paper > 0 ? rows[row].scale * rows[row].paper : NAN, "%10.3f");
        print_score(stream, scores, (eval_row)row, EVAL_TRUE_MAPS);
        for (int answer = EVAL_MEAN; answer <= EVAL_UNCHANGED; answer++)
            print_score(stream, scores, (eval_row)row, (eval_answer)answer);
        eval_verdict v = eval_check_goal(scores, (eval_row)row);
        if (row >= EVAL_RECONSTRUCTION)
            print_number(stream, v.margin, "%+10.4f");
        else
            print_number(stream, v.ratio, "%10.3f");
        print_goal(stream, &v);
    }
}

static const struct {
    eval_row row;
    const char *label;
} shown[] = {{EVAL_ALBEDO, "albedo"},       {EVAL_NORMAL, "normal"},           {EVAL_DEPTH, "depth"},
             {EVAL_ROUGHNESS, "roughness"}, {EVAL_RECONSTRUCTION, "reconst."}, {EVAL_RELIT_NETWORK, "network"},
             {EVAL_RELIT_BRDF, "BRDF"},     {EVAL_TRACED_SHADOWS, "traced"}};
enum { SHOWN = sizeof shown / sizeof shown[0] };

static void print_group_heads(const char *groups, FILE *stream)
{
    fprintf(stream, "\n%-14s%8s", groups, "samples");
    for (int i = 0; i < SHOWN; i++)
        fprintf(stream, "%16s", shown[i].label);
    fputc('\n', stream);
}

static void print_error(FILE *stream, double error, double ratio)
{
    fprintf(stream, "%8.3f", error);
    if (isnan(ratio))
        fprintf(stream, "%8s", "(-)");
    else
        fprintf(stream, " (%.3f)", ratio);
}

/* The model's figures, and behind each the ratio to the better trivial answer or the margin over it. */
static void print_group(const char *name, const eval_scores *scores, FILE *stream)
{
    if (!scores->samples) return;
    fprintf(stream, "%-14s%8zu", name, scores->samples);
    for (int i = 0; i < SHOWN; i++) {
        eval_row row = shown[i].row;
        eval_verdict v = eval_check_goal(scores, row);
        double model = rows[row].scale * eval_score(scores, row, EVAL_MODEL);
        if (isnan(model))
            fprintf(stream, "%16s", "-");
        else if (row >= EVAL_RECONSTRUCTION)
            fprintf(stream, "%7.3f (%+.3f)", model, v.margin);
        else
            print_error(stream, model, v.ratio);
    }
    fputc('\n', stream);
}

static const struct {
    const char *label, *key;
} saturations[EVAL_SATURATIONS] = {
    {"below 10 %", "below_10_percent"}, {"10 to 40 %", "10_to_40_percent"}, {"from 40 %", "from_40_percent"}};

static void print_groups(const eval_report *report, FILE *stream)
{
    print_group_heads("class", stream);
    for (int c = 0; c < report->class_count; c++)
        print_group(report->class_names[c], &report->classes[c], stream);
    print_group_heads("saturated", stream);
    for (int i = 0; i < EVAL_SATURATIONS; i++)
        print_group(saturations[i].label, &report->saturations[i], stream);
}

static const struct {
    const char *label, *key;
} regions[EVAL_REGIONS] = {{"burnt out", "burnt_out"},
                           {"gloss < 3 %", "gloss_below_3_percent"},
                           {"3 to 10 %", "gloss_3_to_10_percent"},
                           {"10 to 30 %", "gloss_10_to_30_percent"},
                           {"from 30 %", "gloss_from_30_percent"}};

static const eval_row maps[] = {EVAL_ALBEDO, EVAL_NORMAL, EVAL_DEPTH, EVAL_ROUGHNESS};
enum { MAPS = sizeof maps / sizeof maps[0] };

static double pixels_of(const eval_scores *scores)
{
    double sum = 0;
    for (int i = 0; i < EVAL_REGIONS; i++)
        sum += (double)scores->regions[i].pixels;
    return sum;
}

static double region_ratio(const eval_region *r, eval_row map)
{
    double trivial = fmin(eval_region_error(r, map, EVAL_MEAN), eval_region_error(r, map, EVAL_INFLATED));
    return trivial > 0 ? eval_region_error(r, map, EVAL_MODEL) / trivial : NAN;
}

/* The model's errors, and behind each the ratio to the better trivial answer there. */
static void print_regions(const eval_scores *scores, FILE *stream)
{
    fprintf(stream, "\n%-14s%8s", "pixels", "share");
    for (int i = 0; i < MAPS; i++)
        fprintf(stream, "%16s", shown[i].label);
    fputc('\n', stream);
    for (int i = 0; i < EVAL_REGIONS; i++) {
        const eval_region *r = &scores->regions[i];
        if (!r->pixels) continue;
        fprintf(stream, "%-14s%6.1f %%", regions[i].label, 100 * (double)r->pixels / pixels_of(scores));
        for (int k = 0; k < MAPS; k++)
            print_error(stream, rows[maps[k]].scale * eval_region_error(r, maps[k], EVAL_MODEL),
                        region_ratio(r, maps[k]));
        fputc('\n', stream);
    }
}

static size_t environments(const eval_report *report)
{
    return report->all.count[EVAL_ENVIRONMENT_BRDF][EVAL_MODEL];
}

static const struct {
    int map;
    const char *name;
} given[] = {{EVAL_GIVEN_ALBEDO, "albedo"},
             {EVAL_GIVEN_NORMAL, "normal"},
             {EVAL_GIVEN_ROUGHNESS, "roughness"},
             {EVAL_GIVEN_DEPTH, "depth"}};

int eval_given_of(const char *name)
{
    for (size_t i = 0; i < sizeof given / sizeof *given; i++)
        if (strcmp(given[i].name, name) == 0) return given[i].map;
    return 0;
}

void eval_print_table(const eval_report *report, FILE *stream)
{
    fprintf(stream, "%s%s (views: %d) on %zu samples of %dx%d; mean maps of %zu samples%s\n\n", report->model,
            report->raw ? ", the network alone" : " as merlin estimate and merlin relight have it", report->views,
            report->all.samples, report->size, report->size, report->means_samples,
            report->means_from_data ? " (of the evaluated data itself, which favours that answer)" : "");
    if (report->white > 1)
        fprintf(stream, "photographs saturate at radiance %g, not at 1 as in the paper\n\n", (double)report->white);
    for (size_t i = 0; i < sizeof given / sizeof *given; i++)
        if (report->given & given[i].map)
            fprintf(stream, "the true %s is given: relighting shows what the rest lacks\n\n", given[i].name);
    size_t relit = environments(report);
    if (relit) fprintf(stream, "relit by environments: the first %zu sample%s\n\n", relit, relit == 1 ? "" : "s");
    print_rows(&report->all, stream);
    print_groups(report, stream);
    print_regions(&report->all, stream);
    fprintf(stream, "\n%.1f s\n", report->seconds);
}

static void add_number(cJSON *o, const char *key, double value)
{
    if (!isnan(value)) json_put_number(o, key, value);
}

static void add_scores(cJSON *o, const eval_scores *scores)
{
    json_put_number(o, "samples", (double)scores->samples);
    json_put_number(o, "saturated_share", scores->saturated / (double)scores->samples);
    for (int row = 0; row < EVAL_ROWS; row++) {
        if (isnan(eval_best_trivial(scores, (eval_row)row))) continue;
        cJSON *r = json_put_object(o, rows[row].key);
        for (int answer = 0; answer < EVAL_ANSWERS; answer++)
            add_number(r, answers[answer], eval_score(scores, (eval_row)row, (eval_answer)answer));
        eval_verdict v = eval_check_goal(scores, (eval_row)row);
        add_number(r, "ratio", v.ratio);
        add_number(r, "margin", v.margin);
        if (rows[row].paper > 0) json_put_number(r, "paper", rows[row].paper);
        if (v.kind == EVAL_NO_GOAL) continue;
        json_put_number(r, "goal", v.goal);
        json_put_bool(r, "holds", v.holds);
    }
}

static void add_regions(cJSON *o, const eval_scores *scores)
{
    for (int i = 0; i < EVAL_REGIONS; i++) {
        const eval_region *r = &scores->regions[i];
        if (!r->pixels) continue;
        cJSON *region = json_put_object(o, regions[i].key);
        json_put_number(region, "pixels", (double)r->pixels);
        for (int k = 0; k < MAPS; k++) {
            cJSON *map = json_put_object(region, rows[maps[k]].key);
            for (int answer = 0; answer <= EVAL_INFLATED; answer++)
                add_number(map, answers[answer], eval_region_error(r, maps[k], (eval_answer)answer));
            add_number(map, "ratio", region_ratio(r, maps[k]));
        }
    }
}

char *eval_report_json(const eval_report *report)
{
    cJSON *o = report_begin(&(warnings){0});
    json_put_text(o, "model", report->model);
    json_put_number(o, "size", report->size);
    json_put_bool(o, "raw", report->raw);
    json_put_number(o, "views", report->views);
    json_put_number(o, "white", (double)report->white);
    cJSON *list = json_put_array(o, "given");
    for (size_t i = 0; i < sizeof given / sizeof *given; i++)
        if (report->given & given[i].map) json_append_text(list, given[i].name);
    json_put_bool(o, "means_from_data", report->means_from_data);
    json_put_number(o, "means_samples", (double)report->means_samples);
    json_put_number(o, "environments", (double)environments(report));
    add_scores(json_put_object(o, "all"), &report->all);
    cJSON *classes = json_put_object(o, "classes");
    for (int c = 0; c < report->class_count; c++)
        add_scores(json_put_object(classes, report->class_names[c]), &report->classes[c]);
    cJSON *by_saturation = json_put_object(o, "saturated");
    for (int i = 0; i < EVAL_SATURATIONS; i++)
        if (report->saturations[i].samples)
            add_scores(json_put_object(by_saturation, saturations[i].key), &report->saturations[i]);
    add_regions(json_put_object(o, "regions"), &report->all);
    char *text = json_print(o);
    cJSON_Delete(o);
    return text;
}
