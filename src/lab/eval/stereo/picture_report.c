/* SPDX-License-Identifier: MIT */
/* picture_table.h's table as text and as JSON. */
#include <cjson/cJSON.h>
#include <math.h>
#include <stdlib.h>

#include "base/json/json_put.h"
#include "base/text/report.h"
#include "lab/eval/metrics/metrics.h"
#include "lab/eval/stereo/picture_table.h"

typedef struct summary {
    double frontal, mean, worst, light;
    int as_flash, lights; /* lights: how many were found */
} summary;

/* Returns the median of the lights that were found; NAN if memory ran out or none was. */
static double median_light(const picture_column *o, int *found)
{
    double *all = malloc(((size_t)o->count + 1) * sizeof *all);
    *found = 0;
    for (int i = 0; all && i < o->count; i++)
        if (!isnan(o->picture[i].light)) all[(*found)++] = o->picture[i].light;
    const double median = eval_median(all, (size_t)*found);
    free(all);
    return median;
}

static summary sum_up(const picture_column *o)
{
    summary s = {.frontal = o->picture[o->frontal].error};
    for (int i = 0; i < o->count; i++) {
        s.mean += o->picture[i].error / o->count;
        s.worst = fmax(s.worst, o->picture[i].error);
        s.as_flash += o->picture[i].as_flash;
    }
    s.light = median_light(o, &s.lights);
    return s;
}

void picture_table_print(const picture_table *t, FILE *stream)
{
    double frontal = 0, mean = 0;
    fprintf(stream, "%s, each picture alone: mean angle of normals in degrees\n\n%-20s%10s%10s%10s%10s%12s%14s%10s\n",
            t->model, "object", "against", "pictures", "frontal", "mean", "worst", "lamp's way", "as flash");
    for (size_t i = 0; i < t->count; i++) {
        const picture_column *o = &t->object[i];
        const summary s = sum_up(o);
        fprintf(stream, "%-20s%10s%10d%10.1f%10.1f%12.1f", o->name, o->true_normals ? "truth" : "stereo", o->count,
                s.frontal, s.mean, s.worst);
        if (s.lights)
            fprintf(stream, "%8.1f of %d", s.light, s.lights);
        else
            fprintf(stream, "%14s", "-");
        fprintf(stream, "%10d\n", s.as_flash);
        frontal += s.frontal / (double)t->count;
        mean += s.mean / (double)t->count;
    }
    fprintf(stream, "%-40s%10.1f%10.1f\n\n%.1f s\n", "mean", frontal, mean, t->seconds);
}

static void add_picture(cJSON *all, const picture_score *p)
{
    cJSON *o = json_append_object(all);
    json_put_text(o, "name", p->name);
    json_put_number(o, "normal_angle_degrees", p->error);
    if (!isnan(p->aside)) json_put_number(o, "light_aside_degrees", p->aside);
    if (!isnan(p->light)) json_put_number(o, "light_direction_degrees", p->light);
    json_put_bool(o, "seen_as_flash_alone", p->as_flash);
}

char *picture_table_json(const picture_table *t)
{
    cJSON *root = report_begin(&(warnings){0});
    json_put_text(root, "model", t->model);
    json_put_number(root, "seconds", t->seconds);
    cJSON *objects = json_put_array(root, "objects");
    for (size_t i = 0; i < t->count; i++) {
        const picture_column *column = &t->object[i];
        const summary s = sum_up(column);
        cJSON *o = json_append_object(objects);
        json_put_text(o, "name", column->name);
        json_put_bool(o, "true_normals", column->true_normals);
        json_put_number(o, "frontal_degrees", s.frontal);
        json_put_number(o, "mean_degrees", s.mean);
        cJSON *all = json_put_array(o, "pictures");
        for (int k = 0; k < column->count; k++)
            add_picture(all, &column->picture[k]);
    }
    char *text = json_print_line(root);
    cJSON_Delete(root);
    return text;
}
