/* SPDX-License-Identifier: MIT */
/* Memory runs out at any allocation of reading or writing a picture: that is said, no picture and no file is left, and
 * nothing is read another way for it, such as not turned. */
#include <libdeflate.h>

#include "dng.h"
#include "each_allocation.h"
#include "failing_memory.h"
#include "image/exr/exr.h"
#include "image/metadata/exif.h"
#include "image/read/read.h"
#include "image/write/figure.h"
#include "image/write/write.h"
#include "merlin/photos.h"
#include "merlin/pictures.h"
#include "writes.h"

enum { WIDTH = 12, HEIGHT = 8 };

/* ---- pictures of every kind ---- */

static float shade(int i)
{
    return (float)(i * 37 % 256) / 255;
}

static img picture_of(int channels)
{
    img p;
    assert_int_equal(img_new(&p, WIDTH, HEIGHT, channels), OK);
    for (size_t i = 0; i < img_value_count(&p); i++)
        p.data[i] = shade((int)i);
    return p;
}

static void put_number(uint8_t *to, uint32_t number)
{
    for (int i = 0; i < 4; i++)
        to[i] = (uint8_t)(number >> (24 - 8 * i));
}

/* Puts a chunk behind the head of a PNG. */
static void add_chunk(const char *path, const char *name, const void *content, size_t size)
{
    enum { HEAD = 33 };
    char *png;
    size_t length;
    assert_int_equal(file_read(path, 1 << 20, &png, &length), OK);
    uint8_t *larger = malloc(length + size + 12), *chunk = larger + HEAD;
    memcpy(larger, png, HEAD);
    put_number(chunk, (uint32_t)size);
    memcpy(chunk + 4, name, 4);
    memcpy(chunk + 8, content, size);
    put_number(chunk + 8 + size, libdeflate_crc32(0, chunk + 4, size + 4));
    memcpy(chunk + 12 + size, png + HEAD, length - HEAD);
    assert_int_equal(file_write(path, larger, length + size + 12), OK);
    free(larger);
    free(png);
}

/* A head with one entry: orientation 6, a quarter turn. */
static const uint8_t quarter_turn[26] = {'I', 'I', 42, 0, 8, 0, 0, 0, 1, 0, 18, 1, 3, 0, 1, 0, 0, 0, 6};

static void write_turned(const char *path, const char *chunk)
{
    char text[256];
    int at = snprintf(text, sizeof text, "Raw profile type exif%c\nexif\n%8zu\n", 0, sizeof quarter_turn);
    for (size_t i = 0; i < sizeof quarter_turn; i++)
        at += snprintf(text + at, sizeof text - (size_t)at, "%02x", quarter_turn[i]);
    if (strcmp(chunk, "eXIf") == 0)
        add_chunk(path, chunk, quarter_turn, sizeof quarter_turn);
    else
        add_chunk(path, chunk, text, (size_t)at);
}

static void write_plain(const char *path, const char *head, size_t head_size)
{
    uint8_t bytes[128 + 3 * WIDTH * HEIGHT] = {0};
    memcpy(bytes, head, head_size);
    for (int i = 0; i < 3 * WIDTH * HEIGHT; i++)
        bytes[head_size + (size_t)i] = (uint8_t)(i * 37);
    assert_int_equal(file_write(path, bytes, head_size + 3 * WIDTH * HEIGHT), OK);
}

static void write_exr(const char *path)
{
    img p = picture_of(3);
    const exr_channel channels[] = {{"R", p.data, 3, false}, {"G", p.data + 1, 3, true}, {"B", p.data + 2, 3, false}};
    const exr_attribute attributes[] = {exr_number("fov", 60), exr_text("note", "none")};
    assert_int_equal(exr_write(path, WIDTH, HEIGHT, channels, 3, attributes, 2), OK);
    img_free(&p);
}

static float grey(int x, int y, int channel)
{
    return shade(x + y * WIDTH + channel) / 2;
}

static void write_all(void)
{
    const dng raw = {.width = 16, .height = 16, .see = grey, .neutral = {1, 1, 1}, .orientation = 1, .floats = 32};
    img p = picture_of(3);
    assert_int_equal(img_write_png(scratch_path("a.png"), &p, IMG_SRGB8), OK);
    assert_int_equal(img_write_png(scratch_path("wide.png"), &p, IMG_LINEAR16), OK);
    assert_int_equal(img_write_png(scratch_path("turned.png"), &p, IMG_SRGB8), OK);
    write_turned(scratch_path("turned.png"), "eXIf");
    assert_int_equal(img_write_png(scratch_path("text.png"), &p, IMG_SRGB8), OK);
    write_turned(scratch_path("text.png"), "tEXt");
    assert_int_equal(img_write_picture(scratch_path("a.jpg"), &p, IMG_JPEG), OK);
    assert_int_equal(img_write_webp(scratch_path("a.webp"), &p), OK);
    write_exr(scratch_path("a.exr"));
    dng_write(scratch_path("a.dng"), &raw);
    write_plain(scratch_path("a.ppm"), "P6 12 8 255\n", 12);
    write_plain(scratch_path("a.tga"), "\0\0\2\0\0\0\0\0\0\0\0\0\14\0\10\0\30\0", 18);
    write_plain(scratch_path("a.bmp"),
                "BM\x56\1\0\0\0\0\0\0\x36\0\0\0"
                "\x28\0\0\0\14\0\0\0\10\0\0\0\1\0\30\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0",
                54);
    img_free(&p);
}

/* ---- reading ---- */

typedef struct reading {
    const char *path;
    img color, alpha;
    exif_facts facts;
    img_facts seen;
    img first; /* what the first run read */
} reading;

static int read_it(void *context)
{
    reading *r = context;
    memset(&r->color, 1, sizeof r->color);
    memset(&r->alpha, 1, sizeof r->alpha);
    status s = img_read(r->path, &r->color, &r->alpha);
    if (s != OK) return s;
    s = exif_read(r->path, &r->facts);
    if (s == OK) s = img_look(r->path, &r->seen);
    if (s != OK) {
        img_free(&r->color);
        img_free(&r->alpha);
    }
    return s;
}

static const char *check_it(void *context, int result)
{
    reading *r = context;
    const char *fault = NULL;
    if (result != OK) return r->color.data || r->alpha.data ? "a picture" : NULL;
    if (r->first.data && (r->color.width != r->first.width ||
                          memcmp(r->color.data, r->first.data, img_value_count(&r->first) * sizeof(float)) != 0))
        fault = "another picture than ever";
    img_free(&r->alpha);
    if (!r->first.data)
        r->first = r->color;
    else
        img_free(&r->color);
    return fault;
}

static void reads_or_says_that_there_is_no_memory(const char *name)
{
    reading r = {.path = scratch_path(name)};
    each_allocation_fails(&(memory_trial){name, read_it, check_it, &r});
    img_free(&r.first);
}

static void lack_of_memory_reads_no_picture(void **state)
{
    (void)state;
    static const char *const names[] = {"a.png", "wide.png", "turned.png", "text.png", "a.exr",
                                        "a.dng", "a.ppm",    "a.tga",      "a.bmp"};
    write_all();
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        reads_or_says_that_there_is_no_memory(names[i]);
}

static void lack_of_memory_beside_libvips_reads_no_picture(void **state)
{
    (void)state;
    write_all();
    failing_memory_of_libraries(false);
    reads_or_says_that_there_is_no_memory("a.jpg");
    reads_or_says_that_there_is_no_memory("a.webp");
    failing_memory_of_libraries(true);
}

/* ---- writing ---- */

typedef struct writing {
    const char *path;
    status (*write)(const char *path, const img *image);
    img image;
    char *first;
    size_t size;
} writing;

static int write_it(void *context)
{
    const writing *w = context;
    return w->write(w->path, &w->image);
}

static const char *check_file(void *context, int result)
{
    writing *w = context;
    char *bytes = NULL;
    size_t size = 0;
    if (folder_has_leftovers()) return "a temporary file";
    if (result != OK) return file_exists(w->path) ? "a file" : NULL;
    assert_int_equal(file_read(w->path, 1 << 20, &bytes, &size), OK);
    assert_int_equal(unlink(w->path), 0);
    const char *fault =
        w->first && (size != w->size || memcmp(bytes, w->first, size) != 0) ? "another file than ever" : NULL;
    if (w->first) {
        free(bytes);
    } else {
        w->first = bytes;
        w->size = size;
    }
    return fault;
}

static status write_srgb(const char *path, const img *image)
{
    return img_write_png(path, image, IMG_SRGB8);
}

static status write_jpeg(const char *path, const img *image)
{
    return img_write_picture(path, image, IMG_JPEG);
}

static status write_layers(const char *path, const img *image)
{
    const exr_channel channels[] = {{"a.R", image->data, 3, false}, {"a.G", image->data + 1, 3, true}};
    const exr_attribute attributes[] = {
        exr_number("fov", 60), exr_text("note", "none"), {.name = "light", .values = {1, 2, 3}, .count = 3}};
    return exr_write(path, image->width, image->height, channels, 2, attributes, 3);
}

static status write_sheet(const char *path, const img *image)
{
    const figure_tile tiles[] = {{"albedo", image}, {"normal", image}, {NULL, image}};
    return figure_sheet(path, tiles, 3, 2, 24);
}

static status write_chart(const char *path, const img *image)
{
    const figure_curve curve = {"loss", image->data, image->data + 8, 8};
    return figure_chart(path, "training", "steps", "loss", false, &curve, 1);
}

static status write_animation(const char *path, const img *image)
{
    merlin_animation *turn = NULL;
    status s = merlin_animation_new(image->width, image->height, 2, &turn);
    if (s == OK) s = merlin_animation_add(turn, image);
    if (s == OK) s = merlin_animation_write(turn, path, 100);
    merlin_animation_free(turn);
    return s;
}

static void writes_or_says_that_there_is_no_memory(const char *name, status (*write)(const char *, const img *))
{
    writing w = {.path = scratch_path(name), .write = write, .image = picture_of(3)};
    each_allocation_fails(&(memory_trial){name, write_it, check_file, &w});
    free(w.first);
    img_free(&w.image);
}

static int list_photos(void *context)
{
    merlin_photos photos;
    const char *const names[] = {"a.png"};
    char *masks[1];
    (void)context;
    int s = merlin_photos_list(scratch, NULL, &photos);
    if (s != MERLIN_OK) assert_null(photos.at);
    if (s == MERLIN_OK) assert_int_equal(photos.count, 1);
    merlin_photos_free(&photos);
    if (s == MERLIN_OK) s = merlin_masks_find(scratch, names, 1, masks);
    if (s == MERLIN_OK) free(masks[0]);
    return s;
}

static const char *check_nothing(void *context, int result)
{
    (void)context;
    (void)result;
    return NULL;
}

static void lack_of_memory_lists_no_photographs(void **state)
{
    (void)state;
    img p = picture_of(3);
    assert_int_equal(img_write_png(scratch_path("a.png"), &p, IMG_SRGB8), OK);
    assert_int_equal(img_write_png(scratch_path("a.mask.png"), &p, IMG_SRGB8), OK);
    assert_int_equal(img_write_png(scratch_path("b.mask.png"), &p, IMG_SRGB8), OK);
    img_free(&p);
    each_allocation_fails(&(memory_trial){"photos_list", list_photos, check_nothing, NULL});
}

static void lack_of_memory_leaves_no_picture(void **state)
{
    (void)state;
    writes_or_says_that_there_is_no_memory("w.png", write_srgb);
    writes_or_says_that_there_is_no_memory("w.jpg", write_jpeg);
    writes_or_says_that_there_is_no_memory("w.exr", write_layers);
    writes_or_says_that_there_is_no_memory("sheet.png", write_sheet);
}

static void lack_of_memory_beside_libvips_leaves_no_picture(void **state)
{
    (void)state;
    failing_memory_of_libraries(false);
    writes_or_says_that_there_is_no_memory("w.webp", img_write_webp);
    writes_or_says_that_there_is_no_memory("turn.webp", write_animation);
    writes_or_says_that_there_is_no_memory("chart.png", write_chart);
    failing_memory_of_libraries(true);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        in_scratch(lack_of_memory_reads_no_picture),
        in_scratch(lack_of_memory_beside_libvips_reads_no_picture),
        in_scratch(lack_of_memory_lists_no_photographs),
        in_scratch(lack_of_memory_leaves_no_picture),
        in_scratch(lack_of_memory_beside_libvips_leaves_no_picture),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
