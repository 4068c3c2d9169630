/* SPDX-License-Identifier: MIT */
#include <cjson/cJSON.h>
#include <math.h>

#include "base/json/json_put.h"
#include "base/text/report.h"
#include "lab/eval/stereo/unknown_table.h"

enum { CELL = 14 };

static const struct {
    const char *heading, *key;
} words[UNKNOWN_WAYS] = {{"network", "network"}, {"refined", "refined"}, {"uncalibrated", "uncalibrated"}};

/* Averages the objects that have the row; *refused: those of them without a result. */
static double mean_of(const unknown_table *t, int row, unknown_way way, size_t *objects, size_t *refused)
{
    double sum = 0;
    *objects = *refused = 0;
    for (size_t i = 0; i < t->count; i++) {
        if (unknown_row_pictures(&t->object[i], row) == 0) continue;
        const double error = t->object[i].error[row][way];
        ++*objects;
        *refused += isnan(error);
        sum += isnan(error) ? 0 : error;
    }
    return *objects > *refused ? sum / (double)(*objects - *refused) : (double)NAN;
}

static void print_row(const unknown_table *t, int row, FILE *stream)
{
    size_t objects, refused;
    mean_of(t, row, UNKNOWN_NETWORK, &objects, &refused);
    if (objects == 0) return;
    if (row == UNKNOWN_ROWS - 1)
        fprintf(stream, "\n%-*s%*zu", CELL, "all", CELL, objects);
    else
        fprintf(stream, "\n%-*d%*zu", CELL, 1 << row, CELL, objects);
    for (int way = 0; way < UNKNOWN_WAYS; way++) {
        const double mean = mean_of(t, row, (unknown_way)way, &objects, &refused);
        char cell[32];
        snprintf(cell, sizeof cell, refused ? "%.2f (-%zu)" : "%.2f", mean, refused);
        fprintf(stream, "%*s", CELL, cell);
    }
}

void unknown_table_print(const unknown_table *t, FILE *stream)
{
    fprintf(stream, "%s on %zu objects; mean angle of normals in degrees, (-N): N of them refused\n\n%-*s%*s", t->model,
            t->count, CELL, "pictures", CELL, "objects");
    for (int way = 0; way < UNKNOWN_WAYS; way++)
        fprintf(stream, "%*s", CELL, words[way].heading);
    for (int row = 0; row < UNKNOWN_ROWS; row++)
        print_row(t, row, stream);
    fprintf(stream, "\n\n%.1f s\n", t->seconds);
}

static void put_object(cJSON *list, const unknown_object *o)
{
    cJSON *to = cJSON_CreateObject();
    json_put_text(to, "name", o->name);
    json_put_number(to, "pictures", o->pictures);
    for (int row = 0; row < UNKNOWN_ROWS; row++) {
        char name[16];
        const int count = unknown_row_pictures(o, row);
        if (count == 0) continue;
        snprintf(name, sizeof name, "%d", count);
        cJSON *errors = json_put_object(to, name);
        for (int way = 0; way < UNKNOWN_WAYS; way++)
            json_put_number(errors, words[way].key, o->error[row][way]);
    }
    cJSON_AddItemToArray(list, to);
}

char *unknown_table_json(const unknown_table *t)
{
    cJSON *root = report_begin(&(warnings){0});
    json_put_text(root, "model", t->model);
    json_put_number(root, "seconds", t->seconds);
    cJSON *list = cJSON_AddArrayToObject(root, "objects");
    for (size_t i = 0; i < t->count && list; i++)
        put_object(list, &t->object[i]);
    char *text = json_print_line(root);
    cJSON_Delete(root);
    return text;
}
