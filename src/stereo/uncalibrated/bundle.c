/* SPDX-License-Identifier: MIT */
#include "stereo/uncalibrated/bundle.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "stereo/fit/field_fit.h"
#include "stereo/uncalibrated/inflate.h"

/* Largest number of pixels per side that are averaged for a cell, and least number of cells that determine lights and
 * surface. */
enum { MOST_PIXELS = 6, FEWEST = 24 };
/* Least share of a cell's area on the object, and of its pixels that have a value. */
static const float covered = 0.5f, readable = 0.5f;

/* Returns the precision for Geman and McClure's loss; values above the ordinary are less certain. */
static float precision_of(float value, float level)
{
    float above = fmaxf(value - level, 0);
    return 1 / (level * level + above * above + 1e-20f);
}

/* ---- selection of cells ---- */

static bool on_object(const merlin_capture *c, int x, int y)
{
    return x >= 0 && y >= 0 && x < c->width && y < c->height &&
           c->mask.data[(size_t)y * (size_t)c->width + (size_t)x] > 0.5f;
}

static void place_grid(bundle *b, int across)
{
    const pst_bounds r = pst_bounds_of(b->problem);
    int width = r.right - r.left + 1, height = r.bottom - r.top + 1, longer = width > height ? width : height;
    b->side = (longer + across - 1) / across;
    b->columns = (width - 1) / b->side + 1;
    b->rows = (height - 1) / b->side + 1;
    b->left = r.left - (b->columns * b->side - width) / 2;
    b->top = r.top - (b->rows * b->side - height) / 2;
    b->step = (float)b->side / b->camera.focal;
    b->radius = 0.5f * (float)longer / b->camera.focal;
}

static bool is_cell(const bundle *b, int column, int row)
{
    int count = 0, x = b->left + column * b->side, y = b->top + row * b->side;
    for (int j = 0; j < b->side; j++)
        for (int i = 0; i < b->side; i++)
            count += on_object(b->problem->capture, x + i, y + j);
    return (float)count >= covered * (float)(b->side * b->side);
}

static int number_corner(bundle *b, int column, int row)
{
    int *at = &b->corner_at[row * (b->columns + 1) + column];
    if (*at < 0) *at = b->corners++;
    return *at;
}

static void list_cells(bundle *b)
{
    const pinhole *camera = &b->camera;
    vec3 sum = {0, 0, 0};
    for (int j = 0; j < b->rows; j++)
        for (int i = 0; i < b->columns; i++) {
            if (!is_cell(b, i, j)) continue;
            bundle_cell *cell = &b->cell[b->cells++];
            cell->x = ((float)b->left + ((float)i + 0.5f) * (float)b->side - camera->x) / camera->focal;
            cell->y = (camera->y - (float)b->top - ((float)j + 0.5f) * (float)b->side) / camera->focal;
            for (int k = 0; k < 4; k++)
                cell->corner[k] = number_corner(b, i + k % 2, j + k / 2);
            sum = vec3_add(sum, vec3_make(cell->x, cell->y, -1));
        }
    b->centre = vec3_scale(sum, 1 / fmaxf((float)b->cells, 1));
}

/* ---- their values ---- */

static size_t list_pixels(const bundle *b, const bundle_cell *cell, uint32_t *pixel)
{
    const merlin_capture *c = b->problem->capture;
    int side = b->side < MOST_PIXELS ? b->side : MOST_PIXELS;
    float x0 = cell->x * b->camera.focal + b->camera.x - 0.5f * (float)b->side;
    float y0 = b->camera.y - cell->y * b->camera.focal - 0.5f * (float)b->side;
    size_t count = 0;
    for (int k = 0; k < side * side; k++) {
        int x = (int)lroundf(x0) + (2 * (k % side) + 1) * b->side / (2 * side);
        int y = (int)lroundf(y0) + (2 * (k / side) + 1) * b->side / (2 * side);
        if (on_object(c, x, y)) pixel[count++] = (uint32_t)((size_t)y * (size_t)c->width + (size_t)x);
    }
    return count;
}

/* Memory for a cell's pixels under all lights. */
typedef struct readings {
    size_t stride;
    float *value, *usable, *mean, *known;
} readings;

static void read_cell(bundle *b, int i, const readings *r)
{
    uint32_t pixel[MOST_PIXELS * MOST_PIXELS];
    bundle_cell *cell = &b->cell[i];
    size_t count = list_pixels(b, cell, pixel), lights = (size_t)b->lights;
    pst_gather(b->problem, pixel, count, r->value, r->usable, r->stride);
    memset(r->mean, 0, r->stride * sizeof *r->mean);
    memset(r->known, 0, r->stride * sizeof *r->known);
    for (size_t j = 0; j < count; j++)
        for (size_t k = 0; k < lights; k++) {
            r->mean[k] += r->usable[j * r->stride + k] * r->value[j * r->stride + k];
            r->known[k] += r->usable[j * r->stride + k];
        }
    for (size_t k = 0; k < lights; k++) {
        r->mean[k] /= fmaxf(r->known[k], 1);
        r->known[k] = r->known[k] > readable * (float)count ? 1 : 0;
    }
    pst_observations o = {.padded = (int)r->stride, .value = r->mean, .usable = r->known};
    cell->level = pst_ordinary_level(&o);
    for (size_t k = 0; k < lights; k++) {
        bool there = r->known[k] > 0 && cell->level > 0;
        b->value[(size_t)i * lights + k] = there ? r->mean[k] : 0;
        b->precision[(size_t)i * lights + k] = there ? precision_of(r->mean[k], cell->level) : 0;
    }
}

static status read_cells(bundle *b)
{
    readings r = {.stride = (size_t)pst_padded(b->lights)};
    size_t most = MOST_PIXELS * MOST_PIXELS * r.stride;
    r.value = malloc((2 * most + 2 * r.stride) * sizeof *r.value);
    if (!r.value) return fail(MERLIN_NO_MEMORY, "no memory for the pixels of a cell");
    r.usable = r.value + most;
    r.mean = r.usable + most;
    r.known = r.mean + r.stride;
    for (int i = 0; i < b->cells; i++)
        read_cell(b, i, &r);
    free(r.value);
    return OK;
}

/* ---- the whole ---- */

static status allocate_values(bundle *b)
{
    size_t values = (size_t)b->cells * (size_t)b->lights;
    b->value = malloc(2 * values * sizeof *b->value);
    b->log_depth = calloc((size_t)b->corners, sizeof *b->log_depth);
    b->position = calloc((size_t)b->lights, sizeof *b->position);
    b->strength = calloc((size_t)b->lights, sizeof *b->strength);
    if (!b->value || !b->log_depth || !b->position || !b->strength)
        return fail(MERLIN_NO_MEMORY, "no memory for %d cells under %d lights", b->cells, b->lights);
    b->precision = b->value + values;
    for (int k = 0; k < b->lights; k++)
        b->strength[k] = 1;
    return OK;
}

bool bundle_is_near(const bundle *b)
{
    return b->kind == BUNDLE_NEAR_EQUAL || b->kind == BUNDLE_NEAR_FREE;
}

status bundle_new(const pst_problem *p, const pinhole *camera, bundle_kind kind, int across, bundle *out)
{
    *out = (bundle){.problem = p, .kind = kind, .camera = *camera, .lights = p->capture->count};
    place_grid(out, across);
    size_t cells = (size_t)out->columns * (size_t)out->rows;
    size_t corners = (size_t)(out->columns + 1) * (size_t)(out->rows + 1);
    out->cell = calloc(cells, sizeof *out->cell);
    out->corner_at = malloc(corners * sizeof *out->corner_at);
    status s = out->cell && out->corner_at ? OK : fail(MERLIN_NO_MEMORY, "no memory for %zu cells", cells);
    if (s == OK) {
        memset(out->corner_at, 0xff, corners * sizeof *out->corner_at);
        list_cells(out);
        if (out->cells < FEWEST)
            s = fail(MERLIN_BAD_INPUT, "the mask is too small or thin to solve without known lights");
    }
    if (s == OK) s = allocate_values(out);
    if (s == OK) s = read_cells(out);
    if (s != OK) bundle_free(out);
    return s;
}

void bundle_free(bundle *b)
{
    free(b->cell);
    free(b->corner_at);
    free(b->value);
    free(b->log_depth);
    free(b->position);
    free(b->strength);
    if (b->expected) {
        free(b->expected->place);
        free(b->expected->sure);
        free(b->expected);
    }
    *b = (bundle){0};
}

static int corner_number(const bundle *b, int column, int row)
{
    if (column < 0 || row < 0 || column > b->columns || row > b->rows) return -1;
    return b->corner_at[row * (b->columns + 1) + column];
}

/* Interpolates bilinearly if all four corners exist, else by a tent wide enough to reach some. */
float bundle_depth(const bundle *b, float x, float y)
{
    float column = (x - (float)b->left) / (float)b->side, row = (y - (float)b->top) / (float)b->side;
    float sum = 0, weights = 0;
    for (int reach = 1; weights <= 0 && reach < 2 * (b->columns + b->rows); reach *= 2)
        for (int j = (int)floorf(row) - reach + 1; j <= (int)floorf(row) + reach; j++)
            for (int i = (int)floorf(column) - reach + 1; i <= (int)floorf(column) + reach; i++) {
                int n = corner_number(b, i, j);
                float w = (1 - fabsf((float)i - column) / (float)reach) * (1 - fabsf((float)j - row) / (float)reach);
                if (n < 0 || !(w > 0)) continue;
                sum += w * b->log_depth[n];
                weights += w;
            }
    return expf(weights > 0 ? sum / weights : 0);
}

void bundle_take(bundle *b, const bundle *from)
{
    memcpy(b->position, from->position, (size_t)b->lights * sizeof *b->position);
    memcpy(b->strength, from->strength, (size_t)b->lights * sizeof *b->strength);
    for (int row = 0; row <= b->rows; row++)
        for (int column = 0; column <= b->columns; column++) {
            int n = corner_number(b, column, row);
            float x = (float)(b->left + column * b->side), y = (float)(b->top + row * b->side);
            if (n >= 0) b->log_depth[n] = logf(bundle_depth(from, x, y));
        }
}

status bundle_inflate(bundle *b, float relief)
{
    img outline = {0}, normal = {0}, height = {0};
    int count = (b->columns + 1) * (b->rows + 1);
    status s = img_new(&outline, b->columns + 1, b->rows + 1, 1);
    for (int i = 0; s == OK && i < count; i++)
        outline.data[i] = b->corner_at[i] >= 0;
    if (s == OK) s = pst_inflate(&outline, &normal, &height);
    float mean = 0;
    for (int i = 0; s == OK && i < count; i++)
        mean += height.data[i] / (float)b->corners; /* 0 outside */
    for (int i = 0; s == OK && i < count; i++)
        if (b->corner_at[i] >= 0) b->log_depth[b->corner_at[i]] = -relief * b->step * (height.data[i] - mean);
    img_free(&outline);
    img_free(&normal);
    img_free(&height);
    return s;
}
