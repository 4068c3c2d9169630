/* SPDX-License-Identifier: MIT */
#include "lab/eval/stereo/stereo_sheet.h"

#include <math.h>

#include "image/write/figure.h"

static const float WHITE = 45;

static const char *const labels[STEREO_ROWS] = {"single image", "relit",          "real",         "relit, uncal.",
                                                "real, uncal.", "relit, univ.",   "real, univ.",  "relit, nfps",
                                                "real, nfps",   "relit, nfps u.", "real, nfps u."};

status stereo_sheet_new(size_t objects, const bool asked[STEREO_ROWS], stereo_sheet *out)
{
    *out = (stereo_sheet){.labels = {"photograph", "normal, true"}};
    size_t columns = 2;
    for (int i = 0; i < STEREO_ROWS; i++) {
        out->asked[i] = asked[i];
        if (!asked[i]) continue;
        out->labels[columns++] = labels[i];
        out->labels[columns++] = "off";
    }
    return sheet_rows_new(objects, columns, out->labels, &out->rows);
}

void stereo_sheet_free(stereo_sheet *sheet)
{
    sheet_rows_free(sheet->rows);
    *sheet = (stereo_sheet){.rows = NULL};
}

/* The angle to the truth; WHITE degrees are white. */
static status show_angle(const img *normal, const merlin_capture *c, img *out)
{
    status s = img_new(out, c->width, c->height, 1);
    for (size_t i = 0, n = (size_t)c->width * (size_t)c->height; s == OK && i < n; i++) {
        if (c->mask.data[i] <= 0.5f) continue;
        vec3 found = vec3_of(normal->data + 3 * i), truth = vec3_of(c->normal_true.data + 3 * i);
        float angle = (float)vec3_angle(found, truth) / WHITE;
        out->data[i] = fminf(angle * angle, 1); /* shown as sRGB, so that grey grows about evenly with the angle */
    }
    return s;
}

/* Makes a row's two tiles, black without a solution. */
static status show_row(const img *normal, const merlin_capture *c, img tile[2])
{
    if (normal->data) {
        status s = figure_normals(normal, &c->mask, &tile[0]);
        return s == OK ? show_angle(normal, c, &tile[1]) : s;
    }
    status s = img_new(&tile[0], c->width, c->height, 1);
    return s == OK ? img_new(&tile[1], c->width, c->height, 1) : s;
}

status stereo_sheet_add(stereo_sheet *sheet, const stereo_object *o, const img normal[STEREO_ROWS])
{
    img *tile = sheet_rows_begin(sheet->rows);
    const merlin_capture *c = &o->capture;
    if (!tile) return OK;
    status s = img_copy(&tile[0], &o->photo);
    if (s == OK) s = figure_normals(&c->normal_true, &c->mask, &tile[1]);
    for (int i = 0; i < STEREO_ROWS && s == OK; i++)
        if (sheet->asked[i]) s = show_row(&normal[i], c, tile += 2);
    if (s == OK) sheet_rows_keep(sheet->rows);
    return s;
}
