#include "eval/stereo_sheet.h"

#include <math.h>
#include <stdlib.h>

#include "image/figure.h"

enum { COLUMNS = 2 + 2 * STEREO_ROWS, TILE = 128 };
static const float DEGREES = 57.2957795f, WHITE = 45;

static const char *const labels[COLUMNS] = {"photograph",    "normal, true", "single image", "off",
                                            "relit",         "off",          "real",         "off",
                                            "relit, uncal.", "off",          "real, uncal.", "off"};

struct stereo_sheet {
    size_t objects, used;
    img *images; /* objects × COLUMNS */
};

status stereo_sheet_new(size_t objects, stereo_sheet **out)
{
    *out = NULL;
    stereo_sheet *sheet = malloc(sizeof *sheet);
    if (sheet) *sheet = (stereo_sheet){objects, 0, calloc(objects * COLUMNS, sizeof(img))};
    if (!sheet || !sheet->images) {
        free(sheet);
        return fail(ERROR_MEMORY, "no memory for a sheet of %zu objects", objects);
    }
    *out = sheet;
    return OK;
}

void stereo_sheet_free(stereo_sheet *sheet)
{
    if (!sheet) return;
    for (size_t i = 0; i < sheet->objects * COLUMNS; i++)
        img_free(&sheet->images[i]);
    free(sheet->images);
    free(sheet);
}

/* The angle to the truth; WHITE degrees are white. */
static status show_angle(const img *normal, const pst_capture *c, img *out)
{
    status s = img_new(out, c->width, c->height, 1);
    for (size_t i = 0, n = (size_t)c->width * (size_t)c->height; s == OK && i < n; i++) {
        if (c->mask.data[i] <= 0.5f) continue;
        const float *a = normal->data + 3 * i, *b = c->normal_true.data + 3 * i;
        float cosine = a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        float angle = DEGREES * acosf(fminf(fmaxf(cosine, -1), 1)) / WHITE;
        out->data[i] = fminf(angle * angle, 1); /* shown as sRGB, so that grey grows about evenly with the angle */
    }
    return s;
}

status stereo_sheet_add(stereo_sheet *sheet, const stereo_object *o, const img normal[STEREO_ROWS])
{
    img *row = sheet->images + sheet->used * COLUMNS;
    const pst_capture *c = &o->capture;
    if (sheet->used == sheet->objects) return OK;
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
    if (s == OK) sheet->used++;
    return s;
}

status stereo_sheet_write(const stereo_sheet *sheet, const char *path)
{
    size_t count = sheet->used * COLUMNS;
    figure_tile *tiles = malloc((count ? count : 1) * sizeof *tiles);
    if (!tiles) return fail(ERROR_MEMORY, "no memory for a sheet of %zu objects", sheet->used);
    for (size_t i = 0; i < count; i++)
        tiles[i] = (figure_tile){labels[i % COLUMNS], &sheet->images[i]};
    status s = figure_sheet(path, tiles, (int)count, COLUMNS, TILE);
    free(tiles);
    return s;
}
