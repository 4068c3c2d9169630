/* SPDX-License-Identifier: MIT */
#include "lab/eval/paper/paper_table3.h"

#include <cjson/cJSON.h>
#include <math.h>
#include <stdlib.h>

#include "base/json/json_put.h"
#include "base/text/report.h"
#include "photo_stereo/subsets.h"

status paper3_table_run(const paper3_options *o, paper3_table *out)
{
    *out = (paper3_table){.of = calloc((size_t)o->count + 1, sizeof *out->of)};
    status s = out->of ? OK : fail(MERLIN_NO_MEMORY, "no memory for a table");
    for (int i = 0; s == OK && i < o->count; i++) {
        stereo_options options = o->stereo;
        options.weights = o->weights[i];
        options.relit_only = i > 0;
        s = stereo_table_run(&options, &out->of[i]);
        if (s == OK) out->count++;
    }
    if (s != OK) paper3_table_free(out);
    return s;
}

void paper3_table_free(paper3_table *t)
{
    for (int i = 0; i < t->count; i++)
        stereo_table_free(&t->of[i]);
    free(t->of);
    *t = (paper3_table){.count = 0};
}

/* The judges' rows of relit and of real pictures. */
static const struct {
    const char *label;
    stereo_row relit, real;
} judges[] = {{"near, lights known", STEREO_RELIT, STEREO_REAL},
              {"uncalibrated", STEREO_RELIT_UNCALIBRATED, STEREO_REAL_UNCALIBRATED},
              {"universal", STEREO_RELIT_UNIVERSAL, STEREO_REAL_UNIVERSAL},
              {"nfps, lights known", STEREO_RELIT_NFPS, STEREO_REAL_NFPS},
              {"nfps, lights unknown", STEREO_RELIT_NFPS_UNCALIBRATED, STEREO_REAL_NFPS_UNCALIBRATED}};
enum { JUDGES = sizeof judges / sizeof *judges };

static void print_spreads(const paper3_table *t, int judge, FILE *stream)
{
    fputs("  spread of the draws, in the rows' order:", stream);
    for (int i = 0; i < t->count; i++)
        fprintf(stream, " %.2f", stereo_table_spread(&t->of[i], judges[judge].relit));
    fprintf(stream, " %.2f\n", stereo_table_spread(&t->of[0], judges[judge].real));
}

void paper3_table_print(const paper3_table *t, FILE *stream)
{
    char label[24];
    fprintf(stream, "Table 3: mean angular error in degrees over %zu objects; %d pictures drawn %d times\n\n",
            t->of[0].count, t->of[0].pictures, t->of[0].draws);
    stereo_table_print_heading(&t->of[0], stream);
    fputs("single image\n", stream);
    for (int i = 0; i < t->count; i++) {
        snprintf(label, sizeof label, "  %.17s", t->of[i].model);
        stereo_table_print_row(&t->of[i], STEREO_SINGLE, label, stream);
    }
    for (int k = 0; k < JUDGES; k++) {
        if (isnan(stereo_table_mean(&t->of[0], judges[k].relit))) continue;
        fprintf(stream, "%s\n", judges[k].label);
        for (int i = 0; i < t->count; i++) {
            snprintf(label, sizeof label, "  by %.14s", t->of[i].model);
            stereo_table_print_row(&t->of[i], judges[k].relit, label, stream);
        }
        stereo_table_print_row(&t->of[0], judges[k].real, "  real images", stream);
        print_spreads(t, k, stream);
    }
    fputs(
        "\nThe paper has, on LUCES by uncalibrated Fast-NFPS: single image 17.06, relit by Sang 16.43, by Li 16.21, by "
        "MERLiN 15.80, real images 14.11.\n",
        stream);
}

char *paper3_table_json(const paper3_table *t)
{
    cJSON *o = report_begin(&(warnings){0});
    json_put_number(o, "table", 3);
    cJSON *list = json_put_array(o, "models");
    for (int i = 0; i < t->count; i++) {
        cJSON *one = cJSON_CreateObject();
        stereo_table_put(&t->of[i], one);
        json_append(list, one);
    }
    char *text = json_print_line(o);
    cJSON_Delete(o);
    return text;
}
