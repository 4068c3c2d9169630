/* SPDX-License-Identifier: MIT */
/* Nearly flat objects with fine relief on their front: coins, plaques, tablets, tiles, cushions, folded sheets. */
#include "base/number.h"
#include "lab/scene/shape/glyph.h"
#include "lab/scene/shape/noise.h"
#include "lab/scene/shape/shape.h"

enum { GRID = 116 };

typedef struct relief {
    float width, height, thickness, square; /* square: the outline's exponent, 2 for an ellipse */
    float bevel, bulge, curl;
    float fbm, fbm_frequency, ridge, ridge_frequency, cells, cell_frequency, letters, letter_size, folds,
        fold_frequency;
    float rim;
    int octaves;
    uint32_t seed;
} relief;

/* Maps the square [-1, 1]² to the superellipse, preserving rays from the middle. */
static void to_outline(const relief *f, float u, float v, float *x, float *y)
{
    float reach = max_of(fabsf(u), fabsf(v)), length = 1;
    if (reach > 1e-6f)
        length = powf(powf(fabsf(u / reach), f->square) + powf(fabsf(v / reach), f->square), -1 / f->square);
    *x = u * length * f->width;
    *y = v * length * f->height;
}

static float relief_height(const relief *f, float x, float y)
{
    vec3 p = vec3_make(x, y, 0.37f);
    float h = 0;
    if (f->fbm > 0) h += f->fbm * noise_fbm(vec3_scale(p, f->fbm_frequency), f->octaves, f->seed);
    if (f->ridge > 0) h += f->ridge * (0.5f - noise_turbulence(vec3_scale(p, f->ridge_frequency), 3, f->seed + 11));
    if (f->cells > 0) {
        noise_cell c = noise_cellular(vec3_scale(p, f->cell_frequency), f->seed + 23);
        h += f->cells * smooth_step(0, 0.35f, c.second - c.first);
    }
    if (f->letters > 0) h += f->letters * glyph_ink(x / f->letter_size, y / f->letter_size, 0.13f, f->seed + 31);
    if (f->folds > 0) {
        float warp = noise_fbm(vec3_scale(p, 1.3f), 2, f->seed + 41);
        h += f->folds * sinf(f->fold_frequency * (x + 0.3f * y + 0.6f * warp)) * (0.6f + 0.4f * warp);
    }
    return h;
}

/* Returns the front surface above the grid point at (u, v) in [-1, 1]². */
static vec3 front_point(const relief *f, float u, float v)
{
    float x, y, edge = 1 - max_of(fabsf(u), fabsf(v));
    to_outline(f, u, v, &x, &y);
    float inner = f->rim > 0 ? smooth_step(f->rim, f->rim + 0.04f, edge) : 1;
    float rise = sqrtf(max_of(0, 1 - (1 - min_of(1, edge / f->bevel)) * (1 - min_of(1, edge / f->bevel))));
    float h = relief_height(f, x, y) * smooth_step(0, 0.12f, edge) * inner + (f->rim > 0 ? 0.05f * (1 - inner) : 0);
    return vec3_make(x, y, rise * f->bevel * 0.4f + f->bulge * (1 - (1 - edge) * (1 - edge)) + h);
}

static relief random_relief(rng *r)
{
    relief f = {.width = 1, .height = rng_range(r, 0.6f, 1), .thickness = rng_range(r, 0.04f, 0.25f)};
    f.square = rng_uniform(r) < 0.45f ? 2 : 2 * powf(15, rng_uniform(r));
    f.bevel = rng_range(r, 0.02f, 0.25f);
    f.bulge = rng_uniform(r) < 0.5f ? rng_range(r, 0, 0.45f) : 0;
    f.curl = rng_uniform(r) < 0.3f ? rng_normal(r) * 0.8f : 0;
    f.rim = rng_uniform(r) < 0.3f ? rng_range(r, 0.04f, 0.15f) : 0;
    f.octaves = 1 + rng_below(r, 5);
    f.seed = rng_u32(r);
    float fine = rng_range(r, 0.5f, 1.3f);
    if (rng_uniform(r) < 0.6f) f.fbm = 0.12f * fine * rng_uniform(r);
    if (rng_uniform(r) < 0.25f) f.ridge = 0.2f * fine * rng_uniform(r);
    if (rng_uniform(r) < 0.2f) f.cells = 0.08f * fine;
    if (rng_uniform(r) < 0.35f) f.letters = rng_range(r, -0.04f, 0.05f) > 0 ? 0.035f : 0.02f;
    if (rng_uniform(r) < 0.3f) f.folds = rng_range(r, 0.01f, 0.09f);
    f.fbm_frequency = 1.2f * powf(8, rng_uniform(r));
    f.ridge_frequency = rng_range(r, 0.8f, 4);
    f.cell_frequency = rng_range(r, 1.5f, 6);
    f.letter_size = rng_range(r, 0.18f, 0.6f);
    f.fold_frequency = rng_range(r, 4, 22);
    return f;
}

/* Adds the flat back: a fan around the middle, and the wall up to the front's border. */
static void close_back(triangle_mesh *mesh, const relief *f, const uint32_t *grid)
{
    enum { BORDER = 4 * GRID };
    int side = GRID + 1;
    uint32_t middle = mesh_add_vertex(mesh, vec3_make(0, 0, -f->thickness)), first = 0, before = 0, before_front = 0;
    for (int i = 0; i <= BORDER; i++) {
        int k = i % BORDER, along = k % GRID;
        int row = k < GRID ? 0 : k < 2 * GRID ? along : k < 3 * GRID ? GRID : GRID - along;
        int column = k < GRID ? along : k < 2 * GRID ? GRID : k < 3 * GRID ? GRID - along : 0;
        uint32_t front = grid[row * side + column];
        if (mesh->failed) return;
        vec3 p = mesh->position[front];
        uint32_t back = i == BORDER ? first : mesh_add_vertex(mesh, vec3_make(p.x, p.y, -f->thickness));
        if (i == 0) {
            first = back;
        } else {
            mesh_add_quad(mesh, before, back, front, before_front, 0);
            mesh_add_triangle(mesh, middle, back, before, 0);
        }
        before = back;
        before_front = front;
    }
}

void shape_relief(rng *r, triangle_mesh *mesh, shape_traits *traits)
{
    relief f = random_relief(r);
    uint32_t grid[(GRID + 1) * (GRID + 1)];
    for (int i = 0; i <= GRID; i++)
        for (int j = 0; j <= GRID; j++) {
            float u = 2 * (float)j / GRID - 1, v = 2 * (float)i / GRID - 1;
            grid[i * (GRID + 1) + j] = mesh_add_vertex(mesh, front_point(&f, u, v));
        }
    for (int i = 0; i < GRID; i++)
        for (int j = 0; j < GRID; j++) {
            const uint32_t *at = &grid[i * (GRID + 1) + j];
            mesh_add_quad(mesh, at[0], at[1], at[GRID + 2], at[GRID + 1], 0);
        }
    close_back(mesh, &f, grid);
    float k = clamp(f.curl, -1, 1);
    for (uint32_t i = 0; i < mesh->vertex_count && fabsf(k) > 0.02f; i++) { /* bends it over an upright cylinder */
        vec3 p = mesh->position[i];
        float angle = k * p.x, radius = 1 / k + p.z;
        mesh->position[i] = vec3_make(radius * sinf(angle), p.y, radius * cosf(angle) - 1 / k);
    }
    *traits = (shape_traits){.name = "relief", .frontal = true, .crease_cosine = 0.5f, .parts = 1};
}
