/* SPDX-License-Identifier: MIT */
/* solver_table.h's table as text and as JSON. */
#include <cjson/cJSON.h>

#include "base/json/json_put.h"
#include "base/text/report.h"
#include "lab/eval/stereo/solver_table.h"

typedef struct figure_words {
    const char *above, *heading, *key;
    double factor; /* of the printed figure */
    int decimals;
    double goal; /* the most that it may be, as it is kept; 0: none */
} figure_words;

/* The goals of robust are what the best of the public solvers has, and a twentieth of its time. */
static const figure_words words[SOLVER_FIGURES] = {
    [SOLVER_LAMBERT_LS] = {"Lambert", "ls", "lambert_ls_degrees", 1, 3, 0.1},
    [SOLVER_GLOSSY_LS] = {"glossy", "ls", "glossy_ls_degrees", 1, 2, 0},
    [SOLVER_GLOSSY_ROBUST] = {"", "robust", "glossy_robust_degrees", 1, 2, 3.38},
    [SOLVER_ROBUST_TIME] = {"", "ms", "robust_seconds_for_20000_pixels", 1e3, 0, 0.2},
    [SOLVER_NEAR_MATTE] = {"matte", "near", "near_matte_degrees", 1, 2, 2},
    [SOLVER_NEAR_MATTE_DEPTH] = {"", "depth %", "near_matte_depth_error", 100, 2, 0.02},
    [SOLVER_NEAR_GLOSSY] = {"glossy", "near", "near_glossy_degrees", 1, 2, 5},
    [SOLVER_NEAR_GLOSSY_DEPTH] = {"", "depth %", "near_glossy_depth_error", 100, 2, 0.02},
};

enum { CELL = 9 };

static void print_cell(solver_figure f, double value, FILE *stream)
{
    fprintf(stream, "%*.*f", CELL, words[f].decimals, words[f].factor * value);
}

static void print_heading(FILE *stream)
{
    fprintf(stream, "%-34s%-*s%s\n%-34s", "", 4 * CELL, "   distant lights", "   LEDs beside the object", "");
    for (int f = 0; f < SOLVER_FIGURES; f++)
        fprintf(stream, "%*s", CELL, words[f].above);
    fprintf(stream, "\n%-16s%8s%10s", "", "pixels", "roughness");
    for (int f = 0; f < SOLVER_FIGURES; f++)
        fprintf(stream, "%*s", CELL, words[f].heading);
    fputc('\n', stream);
}

static void print_goals(const solver_table *t, FILE *stream)
{
    fprintf(stream, "%-34s", "goal, at most");
    for (int f = 0; f < SOLVER_FIGURES; f++) {
        if (words[f].goal > 0)
            print_cell((solver_figure)f, words[f].goal, stream);
        else
            fprintf(stream, "%*s", CELL, "-");
    }
    fprintf(stream, "\n%-34s", "objects that hold it");
    for (int f = 0; f < SOLVER_FIGURES; f++) {
        int held = 0;
        for (size_t i = 0; i < t->count; i++)
            held += t->object[i].figure[f] <= words[f].goal;
        if (words[f].goal > 0)
            fprintf(stream, "%*d", CELL, held);
        else
            fprintf(stream, "%*s", CELL, "-");
    }
    fputc('\n', stream);
}

void solver_table_print(const solver_table *t, FILE *stream)
{
    fprintf(stream, "%zu objects under %d lights, mean angle to the true normals in degrees; ms for 20,000 pixels\n\n",
            t->count, SOLVER_LIGHTS);
    print_heading(stream);
    for (size_t i = 0; i < t->count; i++) {
        const solver_row *row = &t->object[i];
        fprintf(stream, "%-16s%8zu%10.2f", row->name, row->pixels, (double)row->roughness);
        for (int f = 0; f < SOLVER_FIGURES; f++)
            print_cell((solver_figure)f, row->figure[f], stream);
        fputc('\n', stream);
    }
    fprintf(stream, "%-34s", "mean");
    for (int f = 0; f < SOLVER_FIGURES; f++)
        print_cell((solver_figure)f, solver_table_mean(t, (solver_figure)f), stream);
    fputc('\n', stream);
    print_goals(t, stream);
    fprintf(stream, "\n%.1f s\n", t->seconds);
}

char *solver_table_json(const solver_table *t)
{
    cJSON *o = report_begin(&(warnings){0}), *mean = json_put_object(o, "mean");
    cJSON *goal = json_put_object(o, "goal"), *list = json_put_array(o, "objects");
    json_put_number(o, "lights", SOLVER_LIGHTS);
    for (int f = 0; f < SOLVER_FIGURES; f++) {
        json_put_number(mean, words[f].key, solver_table_mean(t, (solver_figure)f));
        if (words[f].goal > 0) json_put_number(goal, words[f].key, words[f].goal);
    }
    for (size_t i = 0; i < t->count; i++) {
        const solver_row *row = &t->object[i];
        cJSON *one = json_append_object(list);
        json_put_text(one, "name", row->name);
        json_put_number(one, "pixels", (double)row->pixels);
        json_put_number(one, "roughness", (double)row->roughness);
        for (int f = 0; f < SOLVER_FIGURES; f++)
            json_put_number(one, words[f].key, row->figure[f]);
    }
    json_put_number(o, "seconds", t->seconds);
    char *text = json_print(o);
    cJSON_Delete(o);
    return text;
}
