/* SPDX-License-Identifier: MIT */
#include "lab/eval/stereo/stereo_sheet.h"

#include <math.h>

#include "image/write/figure.h"

enum { COLUMNS = 2 + 2 * STEREO_ROWS };
static const float WHITE = 45;

static const char *const labels[COLUMNS] = {
    "photograph",    "normal, true", "single image", "off", "relit",        "off", "real",        "off",
    "relit, uncal.", "off",          "real, uncal.", "off", "relit, univ.", "off", "real, univ.", "off"};

status stereo_sheet_new(size_t objects, sheet_rows **out)
{
    return sheet_rows_new(objects, COLUMNS, labels, out);
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

status stereo_sheet_add(sheet_rows *sheet, const stereo_object *o, const img normal[STEREO_ROWS])
{
    img *row = sheet_rows_begin(sheet);
    const merlin_capture *c = &o->capture;
    if (!row) return OK;
    status s = img_copy(&row[0], &o->photo);
    if (s == OK) s = figure_normals(&c->normal_true, &c->mask, &row[1]);
    for (int i = 0; i < STEREO_ROWS && s == OK; i++) {
        if (!normal[i].data) {
            s = img_new(&row[2 + 2 * i], c->width, c->height, 1);
            if (s == OK) s = img_new(&row[3 + 2 * i], c->width, c->height, 1);
            continue;
        }
        s = figure_normals(&normal[i], &c->mask, &row[2 + 2 * i]);
        if (s == OK) s = show_angle(&normal[i], c, &row[3 + 2 * i]);
    }
    if (s == OK) sheet_rows_keep(sheet);
    return s;
}
