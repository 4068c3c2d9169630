/* SPDX-License-Identifier: MIT */
/* light_table.h's table as text and as JSON. */
#include <cjson/cJSON.h>
#include <math.h>

#include "base/json/json_put.h"
#include "base/text/report.h"
#include "lab/eval/tables/light_table.h"

/* Returns the names of a figure: those of the maps are followed by those of the light found. */
static const lit_words *words_of(int figure)
{
    static const lit_words of_light[] = {{"rebuilt", "reconstruction_ssim", 1},
                                         {"as a flash", "seen_as_flash_alone", 1},
                                         {"lamp's way", "light_direction_median_degrees", 1}};
    return figure < LIT_FIGURES ? &lit_figure_words[figure] : &of_light[figure - LIT_FIGURES];
}

static const char *const names[LIGHT_KINDS] = {"flash",
                                               "flash in a room",
                                               "room",
                                               "lamp to 10 degrees",
                                               "lamp to 25 degrees",
                                               "lamp to 40 degrees",
                                               "lamp to 55 degrees",
                                               "lamp further aside",
                                               "lamp in a room"};

enum { CELL = 16, LABEL = 22 };

const char *light_kind_name(light_kind kind)
{
    return names[kind];
}

void light_table_print(const light_table *t, FILE *stream)
{
    const int figures = t->directions ? LIGHT_FIGURES : LIGHT_AS_FLASH; /* the last of all are of the light found */
    fprintf(stream, "%s", t->model);
    if (*t->flash_model) fprintf(stream, " and, for what it sees as a flash alone, %s", t->flash_model);
    fprintf(stream, " on %zu samples; errors in 1e-2, relief in hundredths of the frame's width\n\n%-*s%*s", t->samples,
            LABEL, "light", CELL, "photographs");
    for (int f = 0; f < figures; f++)
        fprintf(stream, "%*s", CELL, words_of(f)->heading);
    for (int kind = 0; kind < LIGHT_KINDS; kind++) {
        if (t->count[kind] == 0) continue;
        fprintf(stream, "\n%-*s%*zu", LABEL, names[kind], CELL, t->count[kind]);
        for (int f = 0; f < figures; f++) {
            if (isnan(t->mean[kind][f]))
                fprintf(stream, "%*s", CELL, "-");
            else
                fprintf(stream, "%*.*f", CELL, f == LIGHT_DIRECTION ? 1 : 2, words_of(f)->factor * t->mean[kind][f]);
        }
    }
    fprintf(stream, "\n\n%.1f s\n", t->seconds);
}

char *light_table_json(const light_table *t)
{
    cJSON *root = report_begin(&(warnings){0});
    json_put_text(root, "model", t->model);
    if (*t->flash_model) json_put_text(root, "flash_model", t->flash_model);
    json_put_number(root, "samples", (double)t->samples);
    json_put_number(root, "seconds", t->seconds);
    cJSON *kinds = json_put_object(root, "lights");
    for (int kind = 0; kind < LIGHT_KINDS; kind++) {
        if (t->count[kind] == 0) continue;
        cJSON *o = json_put_object(kinds, names[kind]);
        json_put_number(o, "photographs", (double)t->count[kind]);
        for (int f = 0; f < (t->directions ? LIGHT_FIGURES : LIGHT_AS_FLASH); f++)
            if (!isnan(t->mean[kind][f])) json_put_number(o, words_of(f)->key, t->mean[kind][f]);
    }
    char *text = json_print_line(root);
    cJSON_Delete(root);
    return text;
}
