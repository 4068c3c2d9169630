/* SPDX-License-Identifier: MIT */
/* detail_table.h's table as text and as JSON. */
#include <cjson/cJSON.h>

#include "base/json/json_put.h"
#include "base/text/report.h"
#include "estimate/photo/network.h"
#include "lab/eval/tables/detail_table.h"

typedef struct figure_words {
    const char *heading, *key;
    double factor; /* of the printed figure */
    int decimals;
} figure_words;

static const figure_words words[DETAIL_FIGURES] = {
    [DETAIL_ALBEDO] = {"albedo", "albedo_error", 100, 3},          [DETAIL_NORMAL] = {"normal", "normal_error", 100, 3},
    [DETAIL_ANGLE] = {"degrees", "normal_angle_degrees", 1, 2},    [DETAIL_DEPTH] = {"depth", "depth_error", 100, 3},
    [DETAIL_ROUGHNESS] = {"roughness", "roughness_error", 100, 2}, [DETAIL_RELIT] = {"relit", "relit_ssim", 1, 4},
};
static const char *const ways[DETAIL_WAYS] = {"small", "large", "both"};

enum { CELL = 10, LABEL = 24 };

void detail_table_print(const detail_table *t, FILE *stream)
{
    fprintf(stream, "%s (views: %d) on %zu samples of %dx%d; errors in 1e-2, relit by BRDF: SSIM\n\n%-*s", t->model,
            t->views, t->samples, t->size, t->size, LABEL, "the network sees");
    for (int f = 0; f < DETAIL_FIGURES; f++)
        fprintf(stream, "%*s", CELL, words[f].heading);
    for (int way = 0; way < DETAIL_WAYS; way++) {
        char label[LABEL + 1];
        if (way == DETAIL_BOTH)
            snprintf(label, sizeof label, "both");
        else
            snprintf(label, sizeof label, "%d pixels a side", way == DETAIL_SMALL ? NETWORK_SIZE : t->larger);
        fprintf(stream, "\n%-*s", LABEL, label);
        for (int f = 0; f < DETAIL_FIGURES; f++)
            fprintf(stream, "%*.*f", CELL, words[f].decimals, words[f].factor * t->mean[way][f]);
    }
    fprintf(stream, "\n\n%.1f s\n", t->seconds);
}

char *detail_table_json(const detail_table *t)
{
    cJSON *root = report_begin(&(warnings){0});
    json_put_text(root, "model", t->model);
    json_put_number(root, "samples", (double)t->samples);
    json_put_number(root, "size", t->size);
    json_put_number(root, "larger", t->larger);
    json_put_number(root, "views", t->views);
    json_put_number(root, "seconds", t->seconds);
    for (int way = 0; way < DETAIL_WAYS; way++) {
        cJSON *o = json_put_object(root, ways[way]);
        for (int f = 0; f < DETAIL_FIGURES; f++)
            json_put_number(o, words[f].key, t->mean[way][f]);
    }
    char *text = json_print_line(root);
    cJSON_Delete(root);
    return text;
}
