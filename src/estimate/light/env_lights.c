/* SPDX-License-Identifier: MIT */
#include "estimate/light/env_lights.h"

#include <stdbool.h>

#include "image/color.h"
#include "optics/octahedron.h"

/* Level of the map that is divided: 64 × 64 cells of three degrees. */
enum { LEVEL = 3, SIDE = ENV_MAP_SIDE >> LEVEL, HALVINGS = 8 };
static const float WHOLE = 4 * PI;

/* A rectangle of cells; the end is exclusive. */
typedef struct part {
    int x0, y0, x1, y1;
} part;

static double weight_of(const img *cells, const part *p, float floor)
{
    double sum = 0;
    for (int y = p->y0; y < p->y1; y++)
        for (int x = p->x0; x < p->x1; x++)
            sum += (double)(color_luminance(img_at(cells, x, y)) + floor);
    return sum;
}

/* Halves a part across its longer side, where the weights of the halves are closest; returns false for a single cell.
 */
static bool halve(const img *cells, float floor, part *p, part *rest)
{
    bool wide = p->x1 - p->x0 >= p->y1 - p->y0;
    int length = wide ? p->x1 - p->x0 : p->y1 - p->y0;
    if (length < 2) return false;
    double half = weight_of(cells, p, floor) / 2, sum = 0;
    int cut = 0;
    for (double next = 0; cut < length - 1; cut++, sum = next) {
        part line = *p;
        *(wide ? &line.x0 : &line.y0) += cut;
        *(wide ? &line.x1 : &line.y1) = (wide ? line.x0 : line.y0) + 1;
        next = sum + weight_of(cells, &line, floor);
        if (cut > 0 && next - half > half - sum) break;
    }
    *rest = *p;
    *(wide ? &rest->x0 : &rest->y0) += cut;
    *(wide ? &p->x1 : &p->y1) = wide ? rest->x0 : rest->y0;
    return true;
}

static env_light light_of(const env_map *e, const part *p, float floor)
{
    const img *cells = &e->levels[LEVEL];
    const float angle = WHOLE / (SIDE * SIDE);
    env_light out = {.solid_angle = angle * (float)((p->x1 - p->x0) * (p->y1 - p->y0))};
    for (int y = p->y0; y < p->y1; y++)
        for (int x = p->x0; x < p->x1; x++) {
            const float *c = img_at(cells, x, y);
            vec3 d = octahedron_direction(((float)x + 0.5f) / SIDE, ((float)y + 0.5f) / SIDE);
            out.direction = vec3_fma(out.direction, color_luminance(c) + 1e-3f * floor, d);
            out.power = vec3_fma(out.power, angle, vec3_of(c));
        }
    vec3 d = vec3_normalize(out.direction);
    out.direction = vec3_make(e->cosine * d.x - e->sine * d.z, d.y, e->sine * d.x + e->cosine * d.z);
    return out;
}

int env_lights(const env_map *e, env_light lights[ENV_LIGHTS_MOST])
{
    part parts[ENV_LIGHTS_MOST] = {{0, 0, SIDE, SIDE}};
    const img *cells = &e->levels[LEVEL];
    float floor = (float)(weight_of(cells, &parts[0], 0) / (SIDE * SIDE)) + 1e-20f;
    int count = 1;
    for (int k = 0; k < HALVINGS; k++) {
        int before = count;
        for (int i = 0; i < before; i++)
            if (halve(cells, floor, &parts[i], &parts[count])) count++;
    }
    for (int i = 0; i < count; i++)
        lights[i] = light_of(e, &parts[i], floor);
    return count;
}
