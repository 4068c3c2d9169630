/* SPDX-License-Identifier: MIT */
#include <assimp/cimport.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/file.h"
#include "image/read/read.h"
#include "image/resize.h"
#include "mesh/surface/surface_mesh.h"
#include "scratch.h"

#include <cmocka.h>

enum { WIDTH = 12, HEIGHT = 9 };

/* A wavy sheet one unit away, whose mask lacks the top left pixel and whose right third lies far behind. */
typedef struct sheet {
    img depth, mask, normal, albedo, roughness;
    mesh_source source;
} sheet;

static void sheet_fill(sheet *s)
{
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++) {
            float *n = img_at(&s->normal, x, y), *a = img_at(&s->albedo, x, y);
            *img_at(&s->depth, x, y) = 1 + 0.02f * sinf((float)(x + y)) + (x >= 8 ? 3.0f : 0.0f);
            *img_at(&s->mask, x, y) = x + y > 0;
            n[0] = 0.3f;
            n[2] = sqrtf(1 - 0.09f);
            a[0] = 0.5f;
            a[1] = (float)y / HEIGHT;
            *img_at(&s->roughness, x, y) = 0.6f; /* 153 of 255 */
        }
}

static void sheet_new(sheet *s, bool perspective)
{
    *s = (sheet){0};
    assert_int_equal(img_new(&s->depth, WIDTH, HEIGHT, 1), OK);
    assert_int_equal(img_new(&s->mask, WIDTH, HEIGHT, 1), OK);
    assert_int_equal(img_new(&s->normal, WIDTH, HEIGHT, 3), OK);
    assert_int_equal(img_new(&s->albedo, WIDTH, HEIGHT, 3), OK);
    assert_int_equal(img_new(&s->roughness, WIDTH, HEIGHT, 1), OK);
    sheet_fill(s);
    s->source = (mesh_source){
        &s->depth, &s->mask, &s->normal, &s->albedo, NULL, &s->roughness, {.focal = perspective ? 10 : 0}, {0, 0}};
    s->source.camera.x = 6;
    s->source.camera.y = 4.5f;
}

static void sheet_free(sheet *s)
{
    img_free(&s->roughness);
    img_free(&s->depth);
    img_free(&s->mask);
    img_free(&s->normal);
    img_free(&s->albedo);
}

static status mesh_write(const char *path, const mesh_source *from)
{
    merlin_mesh mesh;
    status s = surface_mesh_new(from, &mesh);
    if (s == OK) s = merlin_mesh_write(&mesh, path, NULL);
    merlin_mesh_free(&mesh);
    return s;
}

/* The near part has 8 × 9 − 1 vertices and 7 × 8 squares, one of them half; the far part 4 × 9 and 3 × 8. */
enum { VERTICES = 71 + 36, TRIANGLES = 2 * 56 - 1 + 2 * 24 };

/* Merges what the file's format tears apart, and looks at every triangle from the camera. */
static void check_mesh(const char *path, bool colors, bool texture)
{
    const struct aiScene *scene = aiImportFile(path, aiProcess_ValidateDataStructure | aiProcess_JoinIdenticalVertices);
    if (!scene) print_error("%s: %s\n", path, aiGetErrorString());
    assert_non_null(scene);
    assert_int_equal(scene->mNumMeshes, 1);
    const struct aiMesh *m = scene->mMeshes[0];
    assert_int_equal(m->mNumVertices, VERTICES);
    assert_int_equal(m->mNumFaces, TRIANGLES);
    assert_non_null(m->mNormals);
    assert_true((m->mColors[0] != NULL) == colors);
    assert_true((m->mTextureCoords[0] != NULL) == texture);
    for (unsigned f = 0; f < m->mNumFaces; f++) {
        assert_int_equal(m->mFaces[f].mNumIndices, 3);
        const struct aiVector3D *a = &m->mVertices[m->mFaces[f].mIndices[0]],
                                *b = &m->mVertices[m->mFaces[f].mIndices[1]],
                                *c = &m->mVertices[m->mFaces[f].mIndices[2]];
        vec3 p = vec3_make(a->x, a->y, a->z), q = vec3_make(b->x - a->x, b->y - a->y, b->z - a->z),
             r = vec3_make(c->x - a->x, c->y - a->y, c->z - a->z);
        assert_true(vec3_dot(vec3_cross(q, r), p) < 0);
        assert_true(fabsf(a->z - b->z) < 1 && fabsf(a->z - c->z) < 1); /* the jump of 3 is not bridged */
    }
    aiReleaseImport(scene);
}

static void every_format_is_read_back_as_the_same_surface(void **state)
{
    (void)state;
    static const char *const names[] = {"a.ply", "a.obj", "a.glb"};
    sheet s;
    sheet_new(&s, true);
    for (int i = 0; i < 3; i++) {
        assert_int_equal(mesh_write(scratch_path(names[i]), &s.source), OK);
        check_mesh(scratch_path(names[i]), i == 0, i > 0);
    }
    sheet_free(&s);
}

static void an_obj_names_its_material_and_texture(void **state)
{
    (void)state;
    sheet s;
    sheet_new(&s, false);
    assert_int_equal(mesh_write(scratch_path("b.obj"), &s.source), OK);
    char *text;
    size_t size;
    assert_int_equal(file_read(scratch_path("b.obj"), 1 << 20, &text, &size), OK);
    assert_non_null(strstr(text, "mtllib b.mtl\n"));
    free(text);
    assert_int_equal(file_read(scratch_path("b.mtl"), 1 << 20, &text, &size), OK);
    assert_non_null(strstr(text, "map_Kd b.png\n"));
    free(text);
    assert_true(file_exists(scratch_path("b.png")));
    sheet_free(&s);
}

static uint32_t word(const char *at)
{
    const unsigned char *b = (const unsigned char *)at;
    return b[0] | (uint32_t)b[1] << 8 | (uint32_t)b[2] << 16 | (uint32_t)b[3] << 24;
}

static void a_glb_keeps_the_container_rules(void **state)
{
    (void)state;
    sheet s;
    sheet_new(&s, true);
    assert_int_equal(mesh_write(scratch_path("c.glb"), &s.source), OK);
    char *data;
    size_t size;
    assert_int_equal(file_read(scratch_path("c.glb"), 1 << 20, &data, &size), OK);
    assert_memory_equal(data, "glTF", 4);
    assert_int_equal(word(data + 4), 2);
    assert_int_equal(word(data + 8), size);
    uint32_t json = word(data + 12), binary = word(data + 20 + json);
    assert_memory_equal(data + 16, "JSON", 4);
    assert_memory_equal(data + 24 + json, "BIN\0", 4);
    assert_true(json % 4 == 0 && binary % 4 == 0);
    assert_int_equal(28 + json + binary, size);
    data[20 + json - 1] = 0;
    assert_non_null(strstr(data + 20, "\"normalTexture\""));
    assert_non_null(strstr(data + 20, "\"baseColorTexture\""));
    assert_non_null(strstr(data + 20, "\"min\":[")); /* positions have bounds */
    /* the pictures are PNG files at a multiple of four */
    int pictures = 0;
    for (uint32_t at = 0; at + 8 <= binary; at += 4)
        pictures += memcmp(data + 28 + json + at, "\x89PNG\r\n\x1a\n", 8) == 0;
    assert_int_equal(pictures, 3);
    free(data);
    sheet_free(&s);
}

static void a_glb_has_the_roughness_in_green(void **state)
{
    (void)state;
    sheet s;
    sheet_new(&s, true);
    s.source.albedo = s.source.normal = NULL; /* so that it is the only picture, and the last part */
    assert_int_equal(mesh_write(scratch_path("r.glb"), &s.source), OK);
    char *data;
    size_t size, at = 0;
    assert_int_equal(file_read(scratch_path("r.glb"), 1 << 20, &data, &size), OK);
    assert_non_null(strstr(data + 20, "\"metallicRoughnessTexture\":{\"index\":0}"));
    while (at + 8 < size && memcmp(data + at, "\x89PNG\r\n\x1a\n", 8) != 0)
        at++;
    const char *picture = scratch_path("r.png");
    assert_int_equal(file_write(picture, data + at, size - at), OK);
    img read;
    int bits;
    assert_int_equal(img_read_samples(picture, false, &read, &bits), OK);
    for (int i = 0; i < WIDTH * HEIGHT; i++)
        assert_true(read.data[3 * i + 1] == 153 / 255.0f && read.data[3 * i + 2] == 0);
    img_free(&read);
    free(data);
    sheet_free(&s);
}

static void a_glb_of_pixels_is_shown_one_unit_large(void **state)
{
    (void)state;
    sheet s;
    sheet_new(&s, false);
    assert_int_equal(mesh_write(scratch_path("p.glb"), &s.source), OK);
    const struct aiScene *scene =
        aiImportFile(scratch_path("p.glb"), aiProcess_ValidateDataStructure | aiProcess_PreTransformVertices);
    assert_non_null(scene);
    float left = 1, right = -1;
    for (unsigned v = 0; v < scene->mMeshes[0]->mNumVertices; v++) {
        left = fminf(left, scene->mMeshes[0]->mVertices[v].x);
        right = fmaxf(right, scene->mMeshes[0]->mVertices[v].x);
    }
    /* vertices are the middles of WIDTH pixels, the longer side; to a float's precision */
    assert_float_equal(right - left, (WIDTH - 1.0) / WIDTH, 1e-6);
    aiReleaseImport(scene);
    sheet_free(&s);
}

static void albedo_and_normals_may_be_missing(void **state)
{
    (void)state;
    static const char *const names[] = {"d.ply", "d.obj", "d.glb"};
    sheet s;
    sheet_new(&s, true);
    s.source.albedo = s.source.normal = s.source.roughness = NULL;
    for (int i = 0; i < 3; i++) {
        assert_int_equal(mesh_write(scratch_path(names[i]), &s.source), OK);
        check_mesh(scratch_path(names[i]), i == 0, i > 0);
    }
    assert_false(file_exists(scratch_path("d.png")));
    sheet_free(&s);
}

static void a_texture_may_be_finer_than_the_shape(void **state)
{
    (void)state;
    sheet s;
    sheet_new(&s, true);
    img fine = {0};
    assert_int_equal(img_resize(&s.albedo, 3 * WIDTH, 3 * HEIGHT, &fine), OK);
    s.source.texture = &fine;
    assert_int_equal(mesh_write(scratch_path("fine.glb"), &s.source), OK);
    check_mesh(scratch_path("fine.glb"), false, true);
    s.source.albedo = &fine;
    assert_int_equal(mesh_write(scratch_path("fine.ply"), &s.source), MERLIN_WRONG_USE);
    assert_false(file_exists(scratch_path("fine.ply")));
    img_free(&fine);
    sheet_free(&s);
}

static void what_cannot_be_a_mesh_is_refused(void **state)
{
    (void)state;
    sheet s;
    sheet_new(&s, true);
    assert_int_equal(mesh_write(scratch_path("e.stl"), &s.source), MERLIN_WRONG_USE);
    assert_int_equal(mesh_write("/proc/merlin.ply", &s.source), MERLIN_CANNOT_WRITE);
    assert_int_equal(mesh_write("/proc/merlin.glb", &s.source), MERLIN_CANNOT_WRITE);
    memset(s.mask.data, 0, sizeof(float) * WIDTH * HEIGHT);
    assert_int_equal(mesh_write(scratch_path("e.ply"), &s.source), MERLIN_BAD_INPUT);
    assert_false(file_exists(scratch_path("e.ply")));
    sheet_free(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_format_is_read_back_as_the_same_surface),
        cmocka_unit_test(an_obj_names_its_material_and_texture),
        cmocka_unit_test(a_glb_keeps_the_container_rules),
        cmocka_unit_test(a_glb_has_the_roughness_in_green),
        cmocka_unit_test(a_glb_of_pixels_is_shown_one_unit_large),
        cmocka_unit_test(albedo_and_normals_may_be_missing),
        cmocka_unit_test(a_texture_may_be_finer_than_the_shape),
        cmocka_unit_test(what_cannot_be_a_mesh_is_refused),
    };
    return cmocka_run_group_tests(tests, scratch_open, scratch_close);
}
