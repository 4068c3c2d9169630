#include "stereo/inflate.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

#include "base/vec.h"

/* u with one row or column of zeros around the picture, so that neighbours need no test for its edges. */
typedef struct field {
    int width, height;
    float *u;
    unsigned char *inside;
} field;

static size_t field_at(const field *f, int x, int y)
{
    return (size_t)(y + 1) * (size_t)(f->width + 2) + (size_t)(x + 1);
}

static void field_free(field *f)
{
    free(f->u);
    free(f->inside);
}

/* False if memory ran out. */
static bool field_new(const img *mask, field *f)
{
    size_t count = (size_t)(mask->width + 2) * (size_t)(mask->height + 2);
    *f = (field){mask->width, mask->height, calloc(count, sizeof *f->u), calloc(count, 1)};
    if (!f->u || !f->inside) {
        field_free(f);
        return false;
    }
    for (int y = 0; y < f->height; y++)
        for (int x = 0; x < f->width; x++)
            f->inside[field_at(f, x, y)] = *img_at(mask, x, y) > 0.5f;
    return true;
}

/* Successive over-relaxation with Young's best factor for a square of the picture's longer side; three sweeps a pixel
 * of that side bring the error far below what half-pixel edges of the mask leave. */
static void solve_poisson(field *f)
{
    int side = f->width > f->height ? f->width : f->height;
    float omega = 2 / (1 + sinf(3.14159265f / (float)(side + 1)));
    size_t stride = (size_t)f->width + 2;
    for (int sweep = 0; sweep < 3 * side; sweep++) {
        for (int y = 0; y < f->height; y++) {
            for (int x = 0; x < f->width; x++) {
                size_t i = field_at(f, x, y);
                if (!f->inside[i]) continue;
                float mean = (f->u[i - 1] + f->u[i + 1] + f->u[i - stride] + f->u[i + stride]) / 4 + 1;
                f->u[i] += omega * (mean - f->u[i]);
            }
        }
    }
}

/* With h = √u the normal (-∂h/∂x, -∂h/∂y, 1) points along (-∂u/∂x, -∂u/∂y, 2 √u), which stays finite at the edge. */
static void write_surface(const field *f, img *normal, img *height)
{
    size_t stride = (size_t)f->width + 2;
    for (int y = 0; y < f->height; y++) {
        for (int x = 0; x < f->width; x++) {
            size_t i = field_at(f, x, y);
            if (!f->inside[i]) continue;
            float h = sqrtf(f->u[i] > 0 ? f->u[i] : 0);
            vec3 n = {(f->u[i - 1] - f->u[i + 1]) / 2, (f->u[i + stride] - f->u[i - stride]) / 2, 2 * h + 1e-6f};
            n = vec3_normalize(n);
            float *o = img_at(normal, x, y);
            vec3_put(n, o);
            *img_at(height, x, y) = h;
        }
    }
}

status pst_inflate(const img *mask, img *normal, img *height)
{
    *normal = *height = (img){0};
    field f;
    if (!field_new(mask, &f))
        return fail(ERROR_MEMORY, "no memory to inflate a mask of %dx%d", mask->width, mask->height);
    status s = img_new(normal, mask->width, mask->height, 3);
    if (s == OK) s = img_new(height, mask->width, mask->height, 1);
    if (s == OK) {
        solve_poisson(&f);
        write_surface(&f, normal, height);
    } else {
        img_free(normal);
    }
    field_free(&f);
    return s;
}
