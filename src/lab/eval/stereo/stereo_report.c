/* SPDX-License-Identifier: MIT */
/* Prints stereo_table.h's table as text and as JSON. */
#include <cjson/cJSON.h>
#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "base/json/json_put.h"
#include "base/text/report.h"
#include "lab/eval/stereo/stereo_table.h"
#include "photo_stereo/subsets.h"

enum { LABEL_WIDTH = 20, CELL_WIDTH = 9 };

/* Prints headings such as "3" above "superqua" for "3 superquadric": two lines of cells of one width. */
void stereo_table_print_heading(const stereo_table *t, FILE *stream)
{
    for (int line = 0; line < 2; line++) {
        fprintf(stream, "%-*s", LABEL_WIDTH, "");
        for (size_t i = 0; i < t->count; i++) {
            const char *name = t->object[i].name, *blank = strchr(name, ' ');
            int first = blank ? (int)(blank - name) : (int)strlen(name);
            const char *text = line == 0 ? name : blank ? blank + 1 : "";
            int length = line == 0 ? first : (int)strlen(text);
            fprintf(stream, "%*.*s", CELL_WIDTH, length < CELL_WIDTH ? length : CELL_WIDTH - 1, text);
        }
        fprintf(stream, line == 0 ? "%*s\n" : "\n", CELL_WIDTH, "mean");
    }
}

static void print_number(double value, FILE *stream)
{
    if (isnan(value))
        fprintf(stream, "%*s", CELL_WIDTH, "-");
    else
        fprintf(stream, "%*.2f", CELL_WIDTH, value);
}

void stereo_table_print_row(const stereo_table *t, stereo_row row, const char *label, FILE *stream)
{
    int failed = 0;
    fprintf(stream, "%-*s", LABEL_WIDTH, label);
    for (size_t i = 0; i < t->count; i++) {
        print_number(t->object[i].row[row].error, stream);
        failed += t->object[i].row[row].failed;
    }
    print_number(stereo_table_mean(t, row), stream);
    if (failed) fprintf(stream, "   (%d draws without a solution left out)", failed);
    fputc('\n', stream);
}

/* Prints the gain of the row's pictures over the single one, on the objects that were solved. */
static void print_comparison(const stereo_table *t, stereo_row row, const char *label, FILE *stream)
{
    double change = 0;
    size_t better = 0, solved = 0;
    for (size_t i = 0; i < t->count; i++) {
        double gain = t->object[i].row[row].error - t->object[i].row[STEREO_SINGLE].error;
        if (isnan(gain)) continue;
        change += gain;
        better += gain < 0;
        solved++;
    }
    if (!solved) {
        fprintf(stream, "%s against the single image: no object was solved\n", label);
        return;
    }
    fprintf(stream, "%s against the single image: %+.2f degrees; better on %zu of %zu", label, change / (double)solved,
            better, solved);
    const char *before = ", not on ";
    for (size_t i = 0; i < t->count; i++)
        if (t->object[i].row[row].error >= t->object[i].row[STEREO_SINGLE].error) {
            fprintf(stream, "%s%s", before, t->object[i].name);
            before = ", ";
        }
    fputc('\n', stream);
}

static void print_judge(const stereo_table *t, const char *name, stereo_row made, stereo_row taken, FILE *stream)
{
    fprintf(stream, "%s\n", name);
    stereo_table_print_row(t, made, "  relit images", stream);
    stereo_table_print_row(t, taken, "  real images", stream);
}

void stereo_table_print(const stereo_table *t, FILE *stream)
{
    fprintf(stream, "%s, mean angular error in degrees over %zu objects; %d pictures drawn %d times\n\n", t->model,
            t->count, t->pictures, t->draws);
    stereo_table_print_heading(t, stream);
    stereo_table_print_row(t, STEREO_SINGLE, "single image", stream);
    print_judge(t, "calibrated", STEREO_RELIT, STEREO_REAL, stream);
    print_judge(t, "uncalibrated", STEREO_RELIT_UNCALIBRATED, STEREO_REAL_UNCALIBRATED, stream);
    const bool universal = !isnan(stereo_table_mean(t, STEREO_RELIT_UNIVERSAL));
    const bool nfps = !isnan(stereo_table_mean(t, STEREO_RELIT_NFPS));
    if (universal) print_judge(t, "universal", STEREO_RELIT_UNIVERSAL, STEREO_REAL_UNIVERSAL, stream);
    if (nfps) print_judge(t, "nfps, lights known", STEREO_RELIT_NFPS, STEREO_REAL_NFPS, stream);
    if (nfps && universal)
        print_judge(t, "nfps, lights unknown", STEREO_RELIT_NFPS_UNCALIBRATED, STEREO_REAL_NFPS_UNCALIBRATED, stream);
    fputc('\n', stream);
    print_comparison(t, STEREO_RELIT, "relit images", stream);
    print_comparison(t, STEREO_RELIT_UNCALIBRATED, "relit images, uncalibrated,", stream);
    if (universal) print_comparison(t, STEREO_RELIT_UNIVERSAL, "relit images, universal,", stream);
    if (nfps) print_comparison(t, STEREO_RELIT_NFPS, "relit images, nfps,", stream);
    fprintf(stream, "%.1f s\n", t->seconds);
}

/* ---- JSON ---- */

static const char *const keys[STEREO_ROWS] = {"single_image",
                                              "relit_images",
                                              "real_images",
                                              "relit_images_uncalibrated",
                                              "real_images_uncalibrated",
                                              "relit_images_universal",
                                              "real_images_universal",
                                              "relit_images_nfps",
                                              "real_images_nfps",
                                              "relit_images_nfps_uncalibrated",
                                              "real_images_nfps_uncalibrated"};

static void add_number(cJSON *o, const char *key, double value)
{
    if (!isnan(value)) json_put_number(o, key, value);
}

static cJSON *object_json(const stereo_column *column)
{
    cJSON *o = cJSON_CreateObject();
    json_put_text(o, "name", column->name);
    json_put_number(o, "pixels", (double)column->pixels);
    json_put_number(o, "real_pictures", column->pictures);
    for (int row = 0; row < STEREO_ROWS; row++) {
        if (isnan(column->row[row].error) && !column->row[row].failed) continue; /* not asked for */
        cJSON *r = json_put_object(o, keys[row]);
        add_number(r, "error_degrees", column->row[row].error);
        if (row == STEREO_SINGLE) continue;
        json_put_number(r, "spread_of_draws", column->row[row].spread);
        json_put_number(r, "failed_draws", column->row[row].failed);
    }
    return o;
}

void stereo_table_put(const stereo_table *t, cJSON *o)
{
    json_put_text(o, "model", t->model);
    json_put_number(o, "draws", t->draws);
    json_put_number(o, "pictures_a_draw", t->pictures);
    cJSON *mean = json_put_object(o, "mean");
    for (int row = 0; row < STEREO_ROWS; row++)
        add_number(mean, keys[row], stereo_table_mean(t, (stereo_row)row));
    cJSON *list = json_put_array(o, "objects");
    for (size_t i = 0; i < t->count; i++)
        json_append(list, object_json(&t->object[i]));
    json_put_number(o, "seconds", t->seconds);
}

char *stereo_table_json(const stereo_table *t)
{
    cJSON *o = report_begin(&(warnings){0});
    stereo_table_put(t, o);
    char *text = json_print(o);
    cJSON_Delete(o);
    return text;
}
