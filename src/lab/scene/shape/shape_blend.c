/* SPDX-License-Identifier: MIT */
/* Smooth implicit bodies: clusters of blended solids, and symmetric figures with body, head, limbs, ears and eyes, as
 * toys and figurines have. */
#include "base/number.h"
#include "lab/scene/shape/implicit.h"
#include "lab/scene/shape/shape.h"

/* Cells along the longest side; long and thin bodies get fewer triangles. */
enum { CELLS = 68 };

static blob make_blob(blob_kind kind, vec3 centre, vec3 radii, vec3 angles, float blend)
{
    return (blob){kind, false, centre, rotation_xyz(angles.x, angles.y, angles.z), radii, blend};
}

static void add_pair(implicit *shape, blob b)
{
    implicit_add(shape, b);
    b.centre.x = -b.centre.x;
    /* mirroring a rotation in x = 0 changes the sign of the entries that mix x with y and z */
    b.rotation.row[0].y = -b.rotation.row[0].y;
    b.rotation.row[0].z = -b.rotation.row[0].z;
    b.rotation.row[1].x = -b.rotation.row[1].x;
    b.rotation.row[2].x = -b.rotation.row[2].x;
    implicit_add(shape, b);
}

static void heap(rng *r, implicit *shape)
{
    int count = 2 + rng_below(r, 7);
    float blend = rng_range(r, 0.02f, 0.45f);
    for (int i = 0; i < count; i++) {
        blob b = {.kind = (blob_kind)rng_below(r, 3), .rotation = random_rotation(r), .blend = blend};
        if (i) {
            vec3 from = shape->blob[rng_below(r, i)].centre;
            float away = rng_range(r, 0.2f, 0.42f);
            b.centre = vec3_fma(from, away, random_direction(r));
        }
        float size = i ? rng_range(r, 0.5f, 1) : 1;
        b.radii = vec3_scale(random_between(r, 0.15f, 0.5f), size);
        if (b.kind == BLOB_CAPSULE) b.radii.z = b.radii.x * rng_range(r, 0.4f, 1.2f);
        implicit_add(shape, b);
    }
    if (rng_uniform(r) < 0.3f) {
        blob b =
            make_blob(BLOB_ELLIPSOID, vec3_scale(random_direction(r), 0.5f), (vec3){0, 0, 0}, (vec3){0, 0, 0}, 0.05f);
        b.radii = random_between(r, 0.1f, 0.35f);
        b.carve = true;
        implicit_add(shape, b);
    }
}

typedef struct figure {
    vec3 head;
    vec3 head_radii;
    float blend;
} figure;

static void add_limbs(rng *r, implicit *shape, vec3 body, float blend)
{
    bool four = rng_uniform(r) < 0.5f;
    float length = rng_range(r, 0.08f, 0.4f), thick = rng_range(r, 0.06f, 0.15f), x = body.x * rng_range(r, 0.4f, 0.8f);
    float z = body.z * rng_range(r, 0.3f, 0.7f), y = -body.y * 0.8f - 0.5f * length;
    vec3 radii = {thick * rng_range(r, 0.8f, 1.5f), length, thick},
         lean = {rng_normal(r) * 0.15f, 0, rng_range(r, 0, 0.3f)};
    add_pair(shape, make_blob(BLOB_CAPSULE, vec3_make(x, y, z), radii, lean, blend));
    if (four) add_pair(shape, make_blob(BLOB_CAPSULE, vec3_make(x, y, -z), radii, lean, blend));
    if (rng_uniform(r) < 0.6f) { /* wings or arms */
        vec3 wing = {rng_range(r, 0.05f, 0.12f), body.y * rng_range(r, 0.4f, 0.8f), body.z * rng_range(r, 0.3f, 0.7f)};
        vec3 angles = {rng_range(r, -0.8f, 0.8f), rng_range(r, -0.3f, 0.3f), rng_range(r, -0.1f, 0.9f)};
        vec3 at = {body.x * 0.95f, body.y * rng_range(r, -0.1f, 0.4f), body.z * rng_range(r, -0.3f, 0.3f)};
        add_pair(shape, make_blob(BLOB_ELLIPSOID, at, wing, angles, 0.5f * blend));
    }
    if (rng_uniform(r) < 0.6f) { /* tail */
        vec3 tail = {rng_range(r, 0.05f, 0.12f), rng_range(r, 0.15f, 0.45f), rng_range(r, 0.03f, 0.1f)};
        vec3 at = {0, body.y * rng_range(r, -0.5f, 0.5f), -body.z - 0.6f * tail.y};
        implicit_add(shape, make_blob(BLOB_CAPSULE, at, tail, (vec3){rng_range(r, -2.2f, -0.7f), 0, 0}, blend));
    }
}

static void add_face(rng *r, implicit *shape, const figure *f)
{
    vec3 h = f->head, s = f->head_radii;
    if (rng_uniform(r) < 0.75f) { /* ears or tufts */
        vec3 ear = {s.x * rng_range(r, 0.12f, 0.4f), s.y * rng_range(r, 0.2f, 0.8f), s.x * rng_range(r, 0.03f, 0.2f)};
        float out = rng_range(r, 0.3f, 0.9f);
        vec3 at = {s.x * out, h.y + s.y * sqrtf(1 - out * out) + 0.5f * ear.y, h.z};
        blob_kind kind = rng_uniform(r) < 0.5f ? BLOB_CAPSULE : BLOB_ELLIPSOID;
        if (kind == BLOB_ELLIPSOID) ear.z = max_of(ear.z, 0.06f);
        add_pair(shape, make_blob(kind, at, ear, (vec3){0, 0, -out * rng_range(r, 0.1f, 1)}, 0.4f * f->blend));
    }
    if (rng_uniform(r) < 0.75f) { /* beak, snout or trunk */
        vec3 snout = {s.x * rng_range(r, 0.15f, 0.45f), s.z * rng_range(r, 0.1f, 0.7f),
                      s.x * rng_range(r, 0.04f, 0.35f)};
        vec3 at = {0, h.y - s.y * rng_range(r, 0, 0.35f), h.z + s.z + 0.4f * snout.y};
        vec3 angles = {1.5707963f + rng_range(r, -0.3f, 0.6f), 0, 0};
        implicit_add(shape, make_blob(BLOB_CAPSULE, at, snout, angles, f->blend * rng_range(r, 0.1f, 1)));
    }
}

static figure add_figure(rng *r, implicit *shape)
{
    figure f = {.blend = rng_range(r, 0.04f, 0.25f)};
    vec3 body = {rng_range(r, 0.28f, 0.5f), rng_range(r, 0.3f, 0.65f), rng_range(r, 0.28f, 0.7f)};
    vec3 lean = {rng_range(r, -0.6f, 0.3f), 0, 0};
    implicit_add(shape, make_blob(BLOB_ELLIPSOID, (vec3){0, 0, 0}, body, lean, f.blend));
    float size = rng_range(r, 0.5f, 1.05f);
    f.head_radii = vec3_scale(random_between(r, 0.8f, 1.2f), size * body.x);
    /* the neck is on the leaning body's surface, the head a part of its radius further out */
    float up = rng_range(r, 0.2f, 0.75f), ahead = rng_range(r, -0.1f, 0.9f);
    mat3 turn = rotation_xyz(lean.x, 0, 0);
    vec3 neck = mat3_apply(&turn, vec3_make(0, body.y * cosf(ahead), body.z * sinf(ahead)));
    f.head = vec3_add(neck, vec3_make(0, f.head_radii.y * up * cosf(ahead), f.head_radii.z * up * sinf(ahead)));
    vec3 none = {0, 0, 0}, tilt = {0, rng_normal(r) * 0.2f, 0};
    implicit_add(shape, make_blob(BLOB_ELLIPSOID, f.head, f.head_radii, rng_uniform(r) < 0.3f ? tilt : none, f.blend));
    add_face(r, shape, &f);
    if (rng_uniform(r) < 0.85f) add_limbs(r, shape, body, f.blend);
    if (rng_uniform(r) < 0.25f) { /* a stand */
        vec3 base = {body.x * rng_range(r, 0.8f, 1.4f), 0.07f, max_of(body.x, body.z) * rng_range(r, 0.8f, 1.3f)};
        blob b = make_blob(BLOB_BOX, vec3_make(0, -body.y * 1.05f, 0), base, none, 0.05f);
        implicit_add(shape, b);
    }
    return f;
}

/* Adds balls set halfway into the head, whose surface is found by stepping outward from its centre. */
static void add_eyes(rng *r, triangle_mesh *mesh, const implicit *shape, const figure *f)
{
    float out = rng_range(r, 0.3f, 0.75f), up = rng_range(r, 0, 0.5f),
          size = f->head_radii.x * rng_range(r, 0.1f, 0.32f);
    for (int side = -1; side <= 1; side += 2) {
        vec3 d = vec3_normalize(vec3_make((float)side * out, up, 0.8f)), p = f->head;
        for (int i = 0; i < 24; i++)
            p = vec3_fma(p, max_of(0, -implicit_distance(shape, p)), d);
        uint32_t first = mesh->vertex_count;
        add_ellipsoid(mesh, 10, vec3_make(size, size, size), 1);
        mat3 one = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
        mesh_transform(mesh, first, &one, vec3_fma(p, -0.35f * size, d), true);
    }
}

void shape_blend(rng *r, triangle_mesh *mesh, shape_traits *traits)
{
    implicit shape = {0};
    bool is_figure = rng_uniform(r) < 0.6f;
    *traits = (shape_traits){.name = "blend", .upright = is_figure, .crease_cosine = 0.55f, .parts = 1};
    traits->mirrored = is_figure;
    if (is_figure) {
        figure f = add_figure(r, &shape);
        mesh_add_implicit(mesh, &shape, CELLS, 0);
        if (rng_uniform(r) < 0.6f) {
            add_eyes(r, mesh, &shape, &f);
            traits->parts = 2;
        }
    } else {
        heap(r, &shape);
        mesh_add_implicit(mesh, &shape, CELLS, 0);
    }
    float u = rng_uniform(r);
    if (rng_uniform(r) < 0.6f) random_dents(r, mesh, 0, 0.1f * u * u, 1.5f, 7);
}
