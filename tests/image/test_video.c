/* SPDX-License-Identifier: MIT */
/* Frames of videos: uncompressed ones that are written byte by byte, and MP4s by the project's own writer. */
#include <math.h>

#include "image/color.h"
#include "image/video/video_read.h"
#include "image/video/video_write.h"

#include "writes.h"

enum { WIDTH = 64, HEIGHT = 48, FRAMES = 5 };

/* A YUV4MPEG2 file of one colour in each frame. */
typedef struct y4m {
    const char *more; /* further words of its head */
    int frames, cut;  /* number of frames, and of bytes that are missing at the end */
    uint8_t code[3];
} y4m;

static const char *write_y4m(const y4m *v)
{
    const char *path = scratch_path("a.y4m");
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    fprintf(file, "YUV4MPEG2 W%d H%d F25:1 Ip A1:1 C444%s\n", WIDTH, HEIGHT, v->more ? v->more : "");
    for (int i = 0; i < v->frames; i++) {
        fprintf(file, "FRAME\n");
        for (int k = 0; k < 3 * WIDTH * HEIGHT - (i + 1 == v->frames ? v->cut : 0); k++)
            fputc(v->code[k / (WIDTH * HEIGHT)], file);
    }
    fclose(file);
    return path;
}

/* Reads all frames into one, the last; returns their number, or -1 for a failure. */
static int read_all(const char *path, img *last, img_video_head *head)
{
    img_video *v;
    bool end = false;
    int count = 0;
    *last = (img){0};
    status s = img_video_open(path, &v);
    if (s != OK) return -1;
    if (head) *head = *img_video_head_of(v);
    while (s == OK && !end) {
        img frame;
        s = img_video_next(v, &frame, &end);
        if (s != OK || end) break;
        img_free(last);
        *last = frame;
        count++;
    }
    img_video_close(v);
    if (s == OK) return count;
    img_free(last);
    return -1;
}

static void skip_without_ffmpeg(void)
{
    img_video_out *v;
    const status s = img_video_create(scratch_path("probe.mp4"), WIDTH, HEIGHT, 25, &v);
    if (s == OK) {
        (void)img_video_finish(v, MERLIN_STOPPED);
        return;
    }
    print_message("skipped: %s\n", status_message());
    skip();
}

static void assert_near(const img *frame, int x, int y, const float color[3], float slack)
{
    for (int c = 0; c < 3; c++)
        if (fabsf(img_at(frame, x, y)[c] - color[c]) > slack)
            fail_msg("channel %d at %d %d is %g, not %g", c, x, y, (double)img_at(frame, x, y)[c], (double)color[c]);
}

static void codes_become_light_by_range_and_curve(void **state)
{
    (void)state;
    static const struct {
        const char *more;
        uint8_t code;
        float light; /* by sRGB's curve, as nothing is stated */
    } cases[] = {
        {"", 16, 0},
        {"", 235, 1},
        {"", 126, 0.2159f},
        {"", 255, 1},
        {" XCOLORRANGE=FULL", 0, 0},
        {" XCOLORRANGE=FULL", 255, 1},
        {" XCOLORRANGE=FULL", 128, 0.2158f},
    };
    skip_without_ffmpeg();
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const y4m v = {.more = cases[i].more, .frames = 3, .code = {cases[i].code, 128, 128}};
        const float grey[3] = {cases[i].light, cases[i].light, cases[i].light};
        img frame;
        img_video_head head;
        assert_int_equal(read_all(write_y4m(&v), &frame, &head), 3);
        assert_int_equal(head.width, WIDTH);
        assert_int_equal(head.height, HEIGHT);
        assert_true(fabs(head.rate - 25) < 1e-6);
        assert_near(&frame, 10, 10, grey, 0.004f);
        img_free(&frame);
    }
}

static void small_videos_have_the_matrix_of_bt601(void **state)
{
    (void)state;
    skip_without_ffmpeg();
    /* red of BT.601 in narrow range; by BT.709's matrix it would not be pure */
    const y4m v = {.frames = 1, .code = {81, 90, 240}};
    img frame;
    assert_int_equal(read_all(write_y4m(&v), &frame, NULL), 1);
    assert_near(&frame, 3, 3, (const float[3]){1, 0, 0}, 0.02f);
    img_free(&frame);
}

static void pixels_become_square(void **state)
{
    (void)state;
    skip_without_ffmpeg();
    img frame;
    FILE *file = fopen(scratch_path("wide.y4m"), "wb");
    assert_non_null(file);
    fprintf(file, "YUV4MPEG2 W%d H%d F25:1 Ip A2:1 C444\nFRAME\n", WIDTH, HEIGHT);
    for (int k = 0; k < 3 * WIDTH * HEIGHT; k++)
        fputc(128, file);
    fclose(file);
    assert_int_equal(read_all(scratch_path("wide.y4m"), &frame, NULL), 1);
    assert_int_equal(frame.width, 2 * WIDTH);
    assert_int_equal(frame.height, HEIGHT);
    img_free(&frame);
}

/* ---- MP4 ---- */

/* Makes frame i: dark, with a bright quarter in the upper left. */
static void make_frame(int i, img *out)
{
    assert_int_equal(img_new(out, WIDTH, HEIGHT, 3), OK);
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++)
            for (int c = 0; c < 3; c++)
                img_at(out, x, y)[c] = x < WIDTH / 2 && y < HEIGHT / 2 ? 0.5f : 0.01f * (float)i;
}

static const char *write_mp4(const char *name)
{
    img_video_out *v;
    const char *path = scratch_path(name);
    status s = img_video_create(path, WIDTH, HEIGHT, 30, &v);
    assert_int_equal(s, OK);
    assert_false(file_exists(path));
    for (int i = 0; i < FRAMES && s == OK; i++) {
        img frame;
        make_frame(i, &frame);
        s = img_video_add(v, &frame);
        img_free(&frame);
    }
    assert_int_equal(img_video_finish(v, s), OK);
    return path;
}

static void a_written_video_is_read_back(void **state)
{
    (void)state;
    skip_without_ffmpeg();
    img frame;
    img_video_head head;
    const char *path = write_mp4("a.mp4");
    assert_true(img_is_video(path));
    assert_int_equal(read_all(path, &frame, &head), FRAMES);
    assert_int_equal(head.frames, FRAMES);
    assert_true(fabs(head.rate - 30) < 0.01);
    assert_near(&frame, 8, 8, (const float[3]){0.5f, 0.5f, 0.5f}, 0.03f);
    assert_near(&frame, WIDTH - 8, 8, (const float[3]){0.04f, 0.04f, 0.04f}, 0.02f);
    img_free(&frame);
    assert_false(folder_has_leftovers());
}

static void an_abandoned_video_leaves_nothing(void **state)
{
    (void)state;
    skip_without_ffmpeg();
    img_video_out *v;
    img frame;
    assert_int_equal(img_video_create(scratch_path("b.mp4"), WIDTH, HEIGHT, 30, &v), OK);
    make_frame(0, &frame);
    assert_int_equal(img_video_add(v, &frame), OK);
    img_free(&frame);
    assert_int_equal(img_video_finish(v, MERLIN_STOPPED), MERLIN_STOPPED);
    assert_false(file_exists(scratch_path("b.mp4")));
    assert_false(folder_has_leftovers());
}

/* Writes the numbers of the track's matrix, as a phone that was held upright does. */
static void turn_track(const char *path, const int32_t four[4])
{
    char *data;
    size_t size;
    assert_int_equal(file_read(path, 1 << 24, &data, &size), OK);
    char *head = memmem(data, size, "tkhd", 4);
    assert_non_null(head);
    static const size_t places[4] = {44, 48, 56, 60}; /* of a, b, c and d, from the box's name on */
    for (int i = 0; i < 4; i++) {
        const uint32_t value = (uint32_t)four[i] << 16;
        const uint8_t bytes[4] = {(uint8_t)(value >> 24), (uint8_t)(value >> 16), (uint8_t)(value >> 8),
                                  (uint8_t)value};
        memcpy(head + places[i], bytes, 4);
    }
    assert_int_equal(file_write(path, data, size), OK);
    free(data);
}

static void a_video_is_turned_upright(void **state)
{
    (void)state;
    static const struct {
        int32_t matrix[4];
        bool across;
        int x, y; /* where the bright quarter goes: 0 or 1 */
    } turns[] = {{{1, 0, 0, 1}, false, 0, 0},
                 {{0, 1, -1, 0}, true, 1, 0}, /* clockwise: the upper left becomes the upper right */
                 {{-1, 0, 0, -1}, false, 1, 1},
                 {{0, -1, 1, 0}, true, 0, 1},
                 {{-1, 0, 0, 1}, false, 1, 0}};
    skip_without_ffmpeg();
    const char *path = write_mp4("turned.mp4");
    for (size_t i = 0; i < sizeof turns / sizeof *turns; i++) {
        img frame;
        turn_track(path, turns[i].matrix);
        assert_int_equal(read_all(path, &frame, NULL), FRAMES);
        assert_int_equal(frame.width, turns[i].across ? HEIGHT : WIDTH);
        assert_int_equal(frame.height, turns[i].across ? WIDTH : HEIGHT);
        const int x = frame.width / 4 * (1 + 2 * turns[i].x), y = frame.height / 4 * (1 + 2 * turns[i].y);
        assert_near(&frame, x, y, (const float[3]){0.5f, 0.5f, 0.5f}, 0.03f);
        img_free(&frame);
    }
}

/* ---- what is refused ---- */

static void assert_refused(const char *path, const char *word)
{
    img frame;
    assert_int_equal(read_all(path, &frame, NULL), -1);
    if (!strstr(status_message(), word) || strchr(status_message(), '\n'))
        fail_msg("no \"%s\" in: %s", word, status_message());
}

static void videos_that_were_cut_short_are_refused(void **state)
{
    (void)state;
    skip_without_ffmpeg();
    const y4m v = {.frames = 3, .cut = 100, .code = {100, 128, 128}};
    assert_refused(write_y4m(&v), "cut short after frame");
    char *data;
    size_t size;
    assert_int_equal(file_read(write_mp4("a.mp4"), 1 << 24, &data, &size), OK);
    for (int tenth = 0; tenth < 10; tenth++) {
        assert_int_equal(file_write(scratch_path("cut.mp4"), data, size * (size_t)tenth / 10), OK);
        assert_refused(scratch_path("cut.mp4"), "cut.mp4");
    }
    free(data);
}

static void damaged_videos_are_refused_or_read_without_a_crash(void **state)
{
    (void)state;
    skip_without_ffmpeg();
    char *data;
    size_t size;
    uint32_t random = 7;
    assert_int_equal(file_read(write_mp4("a.mp4"), 1 << 24, &data, &size), OK);
    for (int round = 0; round < 300; round++) {
        char *changed = malloc(size);
        assert_non_null(changed);
        memcpy(changed, data, size);
        for (int k = 0; k < 1 + round % 8; k++) {
            random = random * 1664525 + 1013904223;
            changed[random % size] = (char)(random >> 24);
        }
        assert_int_equal(file_write(scratch_path("damaged.mp4"), changed, size), OK);
        free(changed);
        img frame;
        if (read_all(scratch_path("damaged.mp4"), &frame, NULL) < 0) assert_null(strchr(status_message(), '\n'));
        img_free(&frame);
    }
    free(data);
}

static void lists_of_other_files_are_not_followed(void **state)
{
    (void)state;
    skip_without_ffmpeg();
    (void)write_mp4("a.mp4");
    static const char playlist[] = "#EXTM3U\n#EXT-X-TARGETDURATION:9\n#EXTINF:9,\na.mp4\n#EXT-X-ENDLIST\n";
    static const char list[] = "ffconcat version 1.0\nfile a.mp4\n";
    assert_int_equal(file_write(scratch_path("a.m3u8"), playlist, sizeof playlist - 1), OK);
    assert_int_equal(file_write(scratch_path("list.mp4"), list, sizeof list - 1), OK);
    assert_false(img_is_video(scratch_path("a.m3u8")));
    assert_refused(scratch_path("a.m3u8"), "damaged");
    assert_refused(scratch_path("list.mp4"), "damaged");
}

static void frames_beyond_the_limit_are_refused(void **state)
{
    (void)state;
    skip_without_ffmpeg();
    FILE *file = fopen(scratch_path("large.y4m"), "wb");
    assert_non_null(file);
    fprintf(file, "YUV4MPEG2 W30000 H30000 F25:1 Ip A1:1 C444\nFRAME\n");
    fclose(file);
    assert_refused(scratch_path("large.y4m"), "large.y4m");
}

static void pictures_are_no_videos(void **state)
{
    (void)state;
    assert_false(img_is_video(MERLIN_SOURCE_DIR "/examples/demo.png"));
    assert_false(img_is_video(scratch_path("missing.mp4")));
    static const char heic[] = "\0\0\0\x18"
                               "ftypheic\0\0\0\0mif1heic";
    assert_int_equal(file_write(scratch_path("a.heic"), heic, sizeof heic - 1), OK);
    assert_false(img_is_video(scratch_path("a.heic")));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        in_scratch(codes_become_light_by_range_and_curve),
        in_scratch(small_videos_have_the_matrix_of_bt601),
        in_scratch(pixels_become_square),
        in_scratch(a_written_video_is_read_back),
        in_scratch(an_abandoned_video_leaves_nothing),
        in_scratch(a_video_is_turned_upright),
        in_scratch(videos_that_were_cut_short_are_refused),
        in_scratch(damaged_videos_are_refused_or_read_without_a_crash),
        in_scratch(lists_of_other_files_are_not_followed),
        in_scratch(frames_beyond_the_limit_are_refused),
        in_scratch(pictures_are_no_videos),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
