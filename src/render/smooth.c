#include "render/smooth.h"

#include <math.h>

#include "optics/camera.h"

/* What a perfectly black surface still reflects: keeps the division by the albedo bounded. */
static const float lobe_reflectance = 0.05f;

typedef struct guides {
    const sample *s;
    img light; /* the layer without albedo and coverage */
    float depth_scale;
    int radius;
} guides;

static void divide_albedo(guides *g, const img *layer)
{
    for (size_t i = 0; i < (size_t)layer->width * (size_t)layer->height; i++) {
        float coverage = g->s->mask.data[i];
        for (size_t c = 3 * i; c < 3 * i + 3; c++)
            g->light.data[c] =
                coverage > 0 ? layer->data[c] / (coverage * (g->s->albedo.data[c] + lobe_reflectance)) : 0;
    }
}

/* How much pixel j tells about pixel i: its coverage, if it lies on the same smooth piece of surface. */
static float likeness(const guides *g, size_t i, size_t j, float distance2)
{
    const float *n = g->s->normal.data + 3 * i, *m = g->s->normal.data + 3 * j;
    float cosine = fmaxf(0, n[0] * m[0] + n[1] * m[1] + n[2] * m[2]), c2 = cosine * cosine, c4 = c2 * c2;
    float reach = (float)((g->radius + 1) * (g->radius + 1)), near = fmaxf(0, 1 - distance2 / reach);
    float step = (g->s->depth.data[i] - g->s->depth.data[j]) * g->depth_scale / g->s->depth.data[i];
    float apart = 1 + step * step / (1 + distance2);
    return g->s->mask.data[j] * c4 * c4 * near / (apart * apart);
}

static void filter_pixel(const guides *g, int x, int y, img *layer)
{
    int w = layer->width, h = layer->height;
    size_t i = (size_t)y * (size_t)w + (size_t)x;
    float sum[3] = {0, 0, 0}, total = 0, coverage = g->s->mask.data[i];
    if (coverage <= 0) return;
    for (int v = y - g->radius < 0 ? 0 : y - g->radius; v <= y + g->radius && v < h; v++)
        for (int u = x - g->radius < 0 ? 0 : x - g->radius; u <= x + g->radius && u < w; u++) {
            size_t j = (size_t)v * (size_t)w + (size_t)u;
            if (g->s->mask.data[j] <= 0) continue;
            float weight = likeness(g, i, j, (float)((u - x) * (u - x) + (v - y) * (v - y)));
            for (size_t c = 0; c < 3; c++)
                sum[c] += weight * g->light.data[3 * j + c];
            total += weight;
        }
    for (size_t c = 0; c < 3; c++)
        layer->data[3 * i + c] = sum[c] / total * coverage * (g->s->albedo.data[3 * i + c] + lobe_reflectance);
}

status smooth_layer(const sample *s, img *layer, int radius)
{
    guides g = {.s = s, .radius = radius};
    status st = img_new(&g.light, layer->width, layer->height, 3);
    if (st != OK) return st;
    camera eye = {layer->width, layer->height, s->fov};
    /* a slope of two pixels' depth a pixel still counts half */
    g.depth_scale = 0.5f / camera_pixel_size(&eye);
    divide_albedo(&g, layer);
    for (int y = 0; y < layer->height; y++)
        for (int x = 0; x < layer->width; x++)
            filter_pixel(&g, x, y, layer);
    img_free(&g.light);
    return OK;
}
