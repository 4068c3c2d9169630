/* SPDX-License-Identifier: MIT */
#include <cjson/cJSON.h>
#include <math.h>
#include <stdbool.h>

#include "base/json/json_put.h"
#include "base/text/report.h"
#include "lab/eval/stereo/unknown_table.h"

enum { CELL = 14, WIDE_CELL = 17, SUREST_CELL = 21 };

static const struct {
    const char *heading, *key, *albedo_key, *surest_key;
} words[UNKNOWN_WAYS] = {{"network", "network", "network_albedo", "network_surest_half"},
                         {"refined", "refined", "refined_albedo", "refined_surest_half"},
                         {"uncalibrated", "uncalibrated", "uncalibrated_albedo", "uncalibrated_surest_half"}};

/* Figures of one way over the objects that have a row. */
typedef struct row_mean {
    double error, albedo, surest; /* NAN if there are none */
    size_t objects, refused;      /* refused: objects without a result */
    size_t known, spread;         /* objects whose albedo is known, and with a spread */
} row_mean;

static row_mean mean_of(const unknown_table *t, int row, unknown_way way)
{
    row_mean m = {0};
    for (size_t i = 0; i < t->count; i++) {
        if (unknown_row_pictures(&t->object[i], row) == 0) continue;
        const double error = t->object[i].error[row][way], albedo = t->object[i].albedo[row][way],
                     surest = t->object[i].surest[row][way];
        m.objects++;
        m.refused += isnan(error);
        m.known += !isnan(albedo);
        m.spread += !isnan(surest);
        m.error += isnan(error) ? 0 : error;
        m.albedo += isnan(albedo) ? 0 : albedo;
        m.surest += isnan(surest) ? 0 : surest;
    }
    m.error = m.objects > m.refused ? m.error / (double)(m.objects - m.refused) : (double)NAN;
    m.albedo = m.known ? m.albedo / (double)m.known : (double)NAN;
    m.surest = m.spread ? m.surest / (double)m.spread : (double)NAN;
    return m;
}

/* Tells which figures some row of a way has. */
typedef struct figures {
    bool has_albedo, has_surest;
} figures;

static figures figures_of(const unknown_table *t, int way)
{
    figures f = {false, false};
    for (int row = 0; row < UNKNOWN_ROWS; row++) {
        const row_mean m = mean_of(t, row, (unknown_way)way);
        f.has_albedo |= m.known > 0;
        f.has_surest |= m.spread > 0;
    }
    return f;
}

static void print_row(const unknown_table *t, int row, FILE *stream)
{
    const size_t objects = mean_of(t, row, UNKNOWN_NETWORK).objects;
    if (objects == 0) return;
    if (row == UNKNOWN_ROWS - 1)
        fprintf(stream, "\n%-*s%*zu", CELL, "all", CELL, objects);
    else
        fprintf(stream, "\n%-*d%*zu", CELL, 1 << row, CELL, objects);
    for (int way = 0; way < UNKNOWN_WAYS; way++) {
        const row_mean m = mean_of(t, row, (unknown_way)way);
        char cell[32];
        snprintf(cell, sizeof cell, m.refused ? "%.2f (-%zu)" : "%.2f", m.error, m.refused);
        fprintf(stream, "%*s", CELL, cell);
    }
    for (int way = 0; way < UNKNOWN_WAYS; way++)
        if (figures_of(t, way).has_albedo)
            fprintf(stream, "%*.2f", WIDE_CELL, 100 * mean_of(t, row, (unknown_way)way).albedo);
    for (int way = 0; way < UNKNOWN_WAYS; way++)
        if (figures_of(t, way).has_surest)
            fprintf(stream, "%*.2f", SUREST_CELL, mean_of(t, row, (unknown_way)way).surest);
}

void unknown_table_print(const unknown_table *t, FILE *stream)
{
    fprintf(stream,
            "%s on %zu objects; mean angle of normals in degrees, (-N): N of them refused; albedo's error in 1e-2, its "
            "scale free; surest: of the half of the pixels whose spread is least\n\n%-*s%*s",
            t->model, t->count, CELL, "pictures", CELL, "objects");
    for (int way = 0; way < UNKNOWN_WAYS; way++)
        fprintf(stream, "%*s", CELL, words[way].heading);
    for (int way = 0; way < UNKNOWN_WAYS; way++)
        if (figures_of(t, way).has_albedo) fprintf(stream, "%*s albedo", WIDE_CELL - 7, words[way].heading);
    for (int way = 0; way < UNKNOWN_WAYS; way++)
        if (figures_of(t, way).has_surest) fprintf(stream, "%*s surest", SUREST_CELL - 7, words[way].heading);
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
        for (int way = 0; way < UNKNOWN_WAYS; way++)
            if (!isnan(o->albedo[row][way])) json_put_number(errors, words[way].albedo_key, o->albedo[row][way]);
        for (int way = 0; way < UNKNOWN_WAYS; way++)
            if (!isnan(o->surest[row][way])) json_put_number(errors, words[way].surest_key, o->surest[row][way]);
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
