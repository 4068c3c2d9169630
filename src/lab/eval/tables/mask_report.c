/* SPDX-License-Identifier: MIT */
/* mask_table.h's table as text and as JSON. */
#include <cjson/cJSON.h>

#include "base/json/json_put.h"
#include "base/text/report.h"
#include "lab/eval/tables/mask_table.h"

/* Above any confidence. */
static const double BEYOND = 2;

static const char *kind_name(int kind)
{
    return kind < 0 ? "all" : kind == MASK_PHOTO ? "photographs" : composite_name((composite_kind)kind);
}

static double percent(size_t part, size_t whole)
{
    return whole ? 100 * (double)part / (double)whole : 0;
}

static void print_photos(const mask_table *t, FILE *stream)
{
    for (size_t i = 0; i < t->count; i++) {
        const mask_row *row = &t->row[i];
        if (row->kind != MASK_PHOTO) continue;
        fprintf(stream, "%-32.32s %6.3f %11.2f%s\n", row->name, row->iou, row->confidence,
                row->found ? "" : "  nothing stands out");
    }
}

static status print_kinds(const mask_table *t, FILE *stream)
{
    fprintf(stream, "\n%-14s%9s%9s%10s%9s%9s%12s\n", "", "pictures", "median", "0.97 and", "sure", "of them", "warned");
    status s = OK;
    for (int kind = 0; kind <= MASK_KINDS && s == OK; kind++) {
        mask_counts c;
        int which = kind < MASK_KINDS ? kind : -1;
        s = mask_table_count(t, which, -1, BEYOND, &c);
        if (s != OK || !c.pictures) continue;
        fprintf(stream, "%-14s%9zu%9.3f%8.1f %%%7.1f %%%7.1f %%%10.1f %%\n", kind_name(which), c.pictures, c.median,
                percent(c.right, c.pictures), percent(c.sure, c.pictures), percent(c.sure_right, c.sure),
                percent(c.told, c.pictures));
    }
    return s;
}

static void bin_limits(int bin, double *low, double *high)
{
    *low = (double)bin / MASK_BINS;
    *high = bin + 1 < MASK_BINS ? (double)(bin + 1) / MASK_BINS : BEYOND;
}

static status print_reliability(const mask_table *t, FILE *stream)
{
    fprintf(stream, "\n%-14s%9s%9s%10s\n", "confidence", "pictures", "median", "0.97 and");
    status s = OK;
    for (int bin = 0; bin < MASK_BINS && s == OK; bin++) {
        double low, high;
        mask_counts c;
        bin_limits(bin, &low, &high);
        s = mask_table_count(t, -1, low, high, &c);
        if (s != OK || !c.pictures) continue;
        fprintf(stream, "%.1f to %.1f    %9zu%9.3f%8.1f %%\n", low, bin + 1 < MASK_BINS ? high : 1.0, c.pictures,
                c.median, percent(c.right, c.pictures));
    }
    return s;
}

status mask_table_print(const mask_table *t, FILE *stream)
{
    print_photos(t, stream);
    status s = print_kinds(t, stream);
    return s == OK ? print_reliability(t, stream) : s;
}

static void add_counts(cJSON *list, const char *name, double low, double high, const mask_counts *c)
{
    cJSON *o = cJSON_CreateObject();
    if (name) json_put_text(o, "kind", name);
    if (!name) json_put_number(o, "confidence_from", low);
    if (!name) json_put_number(o, "confidence_to", high > 1 ? 1 : high);
    json_put_number(o, "pictures", (double)c->pictures);
    json_put_number(o, "iou_median", c->median);
    json_put_number(o, "right", (double)c->right);
    json_put_number(o, "sure", (double)c->sure);
    json_put_number(o, "sure_right", (double)c->sure_right);
    json_put_number(o, "warned", (double)c->told);
    json_append(list, o);
}

static cJSON *row_json(const mask_row *row)
{
    cJSON *o = cJSON_CreateObject();
    json_put_text(o, "name", row->name);
    json_put_text(o, "kind", kind_name(row->kind));
    json_put_bool(o, "found", row->found);
    json_put_number(o, "iou", row->iou);
    json_put_number(o, "confidence", row->confidence);
    return o;
}

char *mask_table_json(const mask_table *t)
{
    cJSON *root = report_begin(&(warnings){0});
    cJSON *kinds = json_put_array(root, "kinds"), *bins = json_put_array(root, "reliability");
    cJSON *list = json_put_array(root, "pictures");
    mask_counts c = {0};
    for (int kind = 0; kind <= MASK_KINDS; kind++) {
        int which = kind < MASK_KINDS ? kind : -1;
        if (mask_table_count(t, which, -1, BEYOND, &c) == OK && c.pictures)
            add_counts(kinds, kind_name(which), 0, 0, &c);
    }
    for (int bin = 0; bin < MASK_BINS; bin++) {
        double low, high;
        bin_limits(bin, &low, &high);
        if (mask_table_count(t, -1, low, high, &c) == OK) add_counts(bins, NULL, low, high, &c);
    }
    for (size_t i = 0; i < t->count; i++)
        json_append(list, row_json(&t->row[i]));
    char *text = json_print_line(root);
    cJSON_Delete(root);
    return text;
}
