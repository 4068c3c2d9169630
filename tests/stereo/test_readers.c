/* SPDX-License-Identifier: MIT */
/* The layouts of data sets and the array files in them, made here byte by byte. */
#include <zlib.h>

#include "capture_files.h"
#include "comma.h"
#include "stereo/arrays/array_file.h"
#include "stereo/capture/capture.h"
#include "stereo/capture/luces.h"

typedef struct bytes {
    unsigned char at[8192];
    size_t size;
} bytes;

static void put(bytes *b, const void *data, size_t size)
{
    assert_true(b->size + size <= sizeof b->at);
    memcpy(b->at + b->size, data, size);
    b->size += size;
}

static void put16(bytes *b, unsigned value)
{
    put(b, (unsigned char[]){(unsigned char)value, (unsigned char)(value >> 8)}, 2);
}

static void put32(bytes *b, unsigned value)
{
    put16(b, value & 0xffff);
    put16(b, value >> 16);
}

static void pad(bytes *b, size_t multiple)
{
    while (b->size % multiple)
        put(b, "", 1);
}

static void pack(const bytes *from, int window_bits, bytes *out)
{
    z_stream z = {.next_in = (unsigned char *)from->at, .avail_in = (uInt)from->size};
    assert_int_equal(deflateInit2(&z, 9, Z_DEFLATED, window_bits, 8, Z_DEFAULT_STRATEGY), Z_OK);
    z.next_out = out->at;
    z.avail_out = sizeof out->at;
    assert_int_equal(deflate(&z, Z_FINISH), Z_STREAM_END);
    out->size = sizeof out->at - z.avail_out;
    deflateEnd(&z);
}

/* A 4 x 5 x 3 matrix of doubles, entry (i, j, k) being i + 10 j + 100 k. */
static void make_matrix(const char *name, bytes *out)
{
    bytes body = {0};
    put32(&body, 6), put32(&body, 8), put32(&body, 6), put32(&body, 0);
    put32(&body, 5), put32(&body, 12), put32(&body, 4), put32(&body, 5), put32(&body, 3);
    pad(&body, 8);
    put32(&body, 1), put32(&body, (unsigned)strlen(name)), put(&body, name, strlen(name));
    pad(&body, 8);
    put32(&body, 9), put32(&body, 60 * 8);
    for (int k = 0; k < 3; k++)
        for (int j = 0; j < 5; j++)
            for (int i = 0; i < 4; i++)
                put(&body, &(double){i + 10 * j + 100 * k}, 8);
    put32(out, 14), put32(out, (unsigned)body.size), put(out, body.at, body.size);
}

static void make_mat(bool compressed, bytes *out)
{
    *out = (bytes){0};
    char head[125];
    memset(head, ' ', sizeof head);
    memcpy(head, "MATLAB 5.0 MAT-file", 19);
    put(out, head, 124), put16(out, 0x100), put(out, "IM", 2);
    bytes matrix = {0}, other = {0}, packed;
    make_matrix("Normal", &other);
    put(out, other.at, other.size);
    make_matrix("Normal_gt", &matrix);
    if (compressed) {
        pack(&matrix, 15, &packed);
        put32(out, 15), put32(out, (unsigned)packed.size);
        matrix = packed;
    }
    put(out, matrix.at, matrix.size);
}

static void matlab_arrays_are_read(void **state)
{
    (void)state;
    for (int compressed = 0; compressed < 2; compressed++) {
        bytes file;
        number_array a;
        make_mat(compressed, &file);
        assert_int_equal(mat_parse((char *)file.at, file.size, "n.mat", "Normal_gt", &a), OK);
        assert_int_equal(a.size[0], 4);
        assert_int_equal(a.size[1], 5);
        assert_int_equal(a.size[2], 3);
        assert_float_equal(a.data[array_at(&a, 3, 1, 2)], 213, 0);
        array_free(&a);
        assert_int_equal(mat_parse((char *)file.at, file.size, "n.mat", "Depth", &a), MERLIN_BAD_INPUT);
        assert_says("no variable Depth");
    }
}

/* An archive with the one member zgt.npy. */
static void make_npz(bool deflated, const char *header, bytes *out)
{
    bytes npy = {0}, packed;
    put(&npy, "\x93NUMPY\x01\x00", 8);
    put16(&npy, (unsigned)strlen(header)), put(&npy, header, strlen(header));
    for (int i = 0; i < 6; i++)
        put(&npy, &(float){(float)i / 2}, 4);
    if (deflated)
        pack(&npy, -15, &packed);
    else
        packed = npy;
    *out = (bytes){0};
    put32(out, 0x04034b50), put16(out, 20), put16(out, 0), put16(out, deflated ? 8 : 0), put32(out, 0);
    put32(out, 0), put32(out, (unsigned)packed.size), put32(out, (unsigned)npy.size), put16(out, 7), put16(out, 0);
    put(out, "zgt.npy", 7), put(out, packed.at, packed.size);
    size_t directory = out->size;
    put32(out, 0x02014b50), put16(out, 20), put16(out, 20), put16(out, 0), put16(out, deflated ? 8 : 0), put32(out, 0);
    put32(out, 0), put32(out, (unsigned)packed.size), put32(out, (unsigned)npy.size), put16(out, 7), put16(out, 0);
    put16(out, 0), put16(out, 0), put16(out, 0), put32(out, 0), put32(out, 0), put(out, "zgt.npy", 7);
    size_t size = out->size - directory;
    put32(out, 0x06054b50), put32(out, 0), put16(out, 1), put16(out, 1), put32(out, (unsigned)size);
    put32(out, (unsigned)directory), put16(out, 0);
}

static const char NPY[] = "{'descr': '<f4', 'fortran_order': False, 'shape': (2, 3), }\n";

static void numpy_archives_are_read(void **state)
{
    (void)state;
    for (int deflated = 0; deflated < 2; deflated++) {
        bytes file;
        number_array a;
        make_npz(deflated, NPY, &file);
        assert_int_equal(npz_parse((char *)file.at, file.size, "z.npz", "zgt", &a), OK);
        assert_int_equal(a.size[0], 2);
        assert_int_equal(a.size[1], 3);
        assert_float_equal(a.data[array_at(&a, 1, 2, 0)], 2.5, 0);
        array_free(&a);
        assert_int_equal(npz_parse((char *)file.at, file.size, "z.npz", "depth", &a), MERLIN_BAD_INPUT);
        assert_says("no array depth");
    }
}

static void headers_that_promise_too_much_are_refused(void **state)
{
    (void)state;
    static const char *const headers[] = {"{'descr': '<f4', 'fortran_order': False, 'shape': (2, 4), }",
                                          "{'descr': '<f4', 'fortran_order': False, 'shape': (99999999, 99999999), }",
                                          "{'descr': '>f4', 'fortran_order': False, 'shape': (2, 3), }",
                                          "{'descr': '|O', 'fortran_order': False, 'shape': (2, 3), }",
                                          "{'descr': '<f4', 'fortran_order': False, 'shape': (), }",
                                          "{"};
    for (size_t i = 0; i < sizeof headers / sizeof *headers; i++) {
        bytes file;
        number_array a;
        make_npz(true, headers[i], &file);
        assert_int_equal(npz_parse((char *)file.at, file.size, "z.npz", "zgt", &a), MERLIN_BAD_INPUT);
        assert_says("z.npz");
        assert_null(a.data);
    }
}

/* From a copy that ends where the file is cut, so that a sanitizer sees a read beyond it. */
static status parse_cut(bool matlab, const bytes *file, size_t size, number_array *a)
{
    char *copy = malloc(size + 1);
    memcpy(copy, file->at, size);
    status s = matlab ? mat_parse(copy, size, "cut", "Normal_gt", a) : npz_parse(copy, size, "cut", "zgt", a);
    free(copy);
    return s;
}

static void files_cut_anywhere_are_refused(void **state)
{
    (void)state;
    for (int kind = 0; kind < 4; kind++) {
        bytes file;
        number_array a;
        bool matlab = kind < 2;
        if (matlab)
            make_mat(kind & 1, &file);
        else
            make_npz(kind & 1, NPY, &file);
        assert_int_equal(parse_cut(matlab, &file, file.size, &a), OK);
        array_free(&a);
        /* zlib's checksum, the last four bytes of a compressed variable, comes after all numbers */
        for (size_t size = 0; size + 5 < file.size; size++) {
            assert_int_equal(parse_cut(matlab, &file, size, &a), MERLIN_BAD_INPUT);
            assert_null(a.data);
        }
    }
}

static status parse_leds(const char *text, luces_params *p)
{
    return luces_parse(text, strlen(text), "led_params.txt", p);
}

static void leds_are_turned_into_this_projects_axes(void **state)
{
    (void)state;
    luces_params p;
    assert_int_equal(parse_leds("N_img nrows ncols f x0 y0 mean_distance\n2 4 6 900 3 2 150\n"
                                "10 20 30 0 0 2 1.5 0.7\n-1 -2 -3 0 1 0 1 2 3 0\n",
                                &p),
                     OK);
    assert_int_equal(p.count, 2);
    assert_int_equal(p.width, 6);
    assert_float_equal(p.camera.focal, 900, 0);
    assert_float_equal(p.camera.distance, 150, 0);
    /* they count pixels from the middle of the first one, this project from its corner */
    assert_float_equal(p.camera.x, 3.5, 0);
    assert_float_equal(p.camera.y, 2.5, 0);
    assert_float_equal(p.light[0].position[0], 10, 0);
    assert_float_equal(p.light[0].position[1], -20, 0);
    assert_float_equal(p.light[0].position[2], -30, 0);
    /* the first LED shines away from the camera, along -z */
    assert_float_equal(p.light[0].direction[2], -1, 0);
    assert_float_equal(p.light[0].lobe, 0.7, 1e-6);
    assert_float_equal(p.light[0].intensity[2], 1.5, 0);
    assert_float_equal(p.light[1].intensity[2], 3, 0);
    luces_free(&p);
}

/* As the data set's own code writes it, and as it read older files. */
static void leds_may_end_in_a_number_that_means_nothing(void **state)
{
    (void)state;
    luces_params p;
    assert_int_equal(parse_leds("N_img nrows ncols f x0 y0 mean_distance sfull:[Lpos Ldir Phi mu 0]\n"
                                "2 4 6 900.000000 3.000000 2.000000 150.000000\n"
                                "1 2 3 0 0 1 4.5 5.5 6.5 0.75 0.0000\n1 2 3 0 0 1 4.5 0.75 0.0000 \n",
                                &p),
                     OK);
    for (int i = 0; i < 2; i++) {
        assert_float_equal(p.light[i].intensity[0], 4.5, 0);
        assert_float_equal(p.light[i].intensity[2], i == 0 ? 6.5 : 4.5, 0);
        assert_float_equal(p.light[i].lobe, 0.75, 0);
    }
    luces_free(&p);
}

static void damaged_led_files_are_refused(void **state)
{
    (void)state;
    static const struct {
        const char *text, *words;
    } cases[] = {
        {"", "no camera"},
        {"header\n1 4 6 900 3 2\n", ":2: expected N_img"},
        {"1.5 4 6 900 3 2 150\n", "not a camera"},
        {"1 4 6 0 3 2 150\n", "not a camera"},
        {"2 4 6 900 3 2 150\n0 0 0 0 0 1 1 1\n", "1 light for 2 images"},
        {"1 4 6 900 3 2 150\n0 0 0 0 0 1 1\n", ":2: expected a light's"},
        {"1 4 6 900 3 2 150\n0 0 0 0 0 1 1 1 1 1 0 0\n", ":2: expected a light's"},
        {"1 4 6 900 3 2 150\n0 0 0 0 0 1 0 1\n", "intensity"},
        {"1 4 6 900 3 2 150\n0 0 0 0 0 1 1 -1\n", "attenuation"},
        {"1 4 6 900 3 2 150\n0 0 0 0 0 0 1 1\n", "no length"},
        {"1 4 6 900 3 2 150\n0 0 nan 0 0 1 1 1\n", "not a finite number"},
        {"1 4 6 900 3 2 150\n0 0 1e30 0 0 1 1 1\n", "out of range"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        luces_params p;
        assert_int_equal(parse_leds(cases[i].text, &p), MERLIN_BAD_INPUT);
        assert_says(cases[i].words);
        assert_null(p.light);
    }
}

/* (0, 0.6, 0.8), with y and z turned to -1: as lights have them. */
static void write_luces_normals(float turned)
{
    img n;
    assert_int_equal(img_new(&n, 3, 2, 3), OK);
    for (int i = 0; i < 6; i++)
        memcpy(n.data + 3 * i, (float[]){0.5f, 0.5f + turned * 0.3f, 0.5f + turned * 0.4f}, 3 * sizeof(float));
    assert_int_equal(img_write_png(scratch_path("normals.png"), &n, IMG_LINEAR16), OK);
    img_free(&n);
}

static void make_luces(int width)
{
    write_text("led_params.txt", "header\n2 2 3 900 1.5 1 150\n1 2 3 0 0 1 1 1\n# between\n4 5 6 0 0 1 1 1\n# end\n");
    write_flat("01.png", width, 2, 3, 0.5f, IMG_LINEAR16);
    write_flat("02.png", width, 2, 3, 0.25f, IMG_LINEAR16);
    write_flat("mask.png", 3, 2, 1, 1, IMG_LINEAR8);
    write_luces_normals(1);
    bytes file;
    make_npz(true, NPY, &file);
    assert_int_equal(file_write(scratch_path("zgt.npz"), file.at, file.size), OK);
}

static void a_luces_folder_is_read_with_its_truth(void **state)
{
    (void)state;
    make_luces(3);
    merlin_capture c;
    assert_int_equal(pst_capture_read(scratch, NULL, &c), OK);
    assert_int_equal(c.count, 2);
    assert_int_equal(c.lighting, MERLIN_NEAR_LIGHTS);
    assert_true(c.intensities_known);
    assert_string_equal(c.name[1], "02.png");
    assert_float_equal(c.light[1].position[2], -6, 0);
    assert_float_equal(c.camera.focal, 900, 0);
    /* unlike the lights, up and toward the camera; 16-bit codes are 3e-5 apart */
    assert_float_equal(img_at(&c.normal_true, 1, 1)[1], 0.6, 1e-4);
    assert_float_equal(img_at(&c.normal_true, 1, 1)[2], 0.8, 1e-4);
    assert_float_equal(*img_at(&c.depth_true, 2, 1), 2.5, 0);
    pst_capture_free(&c);
    make_luces(4);
    assert_int_equal(pst_capture_read(scratch, NULL, &c), MERLIN_BAD_INPUT);
    assert_says("01.png is 4 x 2");
    make_luces(3);
    unlink(scratch_path("02.png"));
    assert_int_equal(pst_capture_read(scratch, NULL, &c), MERLIN_BAD_INPUT);
    assert_says("1 numbered picture, but led_params.txt has 2 lights");
}

static void luces_normals_face_the_camera_whatever_their_axes(void **state)
{
    (void)state;
    make_luces(3);
    write_luces_normals(-1);
    merlin_capture c;
    assert_int_equal(pst_capture_read(scratch, NULL, &c), OK);
    assert_float_equal(img_at(&c.normal_true, 1, 1)[1], 0.6, 1e-4);
    assert_float_equal(img_at(&c.normal_true, 1, 1)[2], 0.8, 1e-4);
    pst_capture_free(&c);
}

static void raw_mosaics_of_luces_are_refused(void **state)
{
    (void)state;
    merlin_capture c;
    assert_int_equal(file_make_folder(scratch_path("RAW")), OK);
    write_text("RAW/led_params.txt", "header\n1 2 3 900 1.5 1 150\n1 2 3 0 0 1 1 1\n");
    write_flat("RAW/01.png", 3, 2, 1, 0.5f, IMG_LINEAR16);
    assert_int_equal(pst_capture_read(scratch_path("RAW/"), NULL, &c), MERLIN_BAD_INPUT);
    assert_says("mosaics");
}

static void a_diligent_folder_is_read_with_its_truth(void **state)
{
    (void)state;
    write_flat("001.png", 5, 4, 3, 0.5f, IMG_LINEAR16);
    write_flat("second light.png", 5, 4, 3, 0.25f, IMG_LINEAR16);
    write_text("filenames.txt", " second light.png \r\n001.png\r\n");
    write_text("light_directions.txt", "0 0 1\n0.6 0 0.8\n");
    write_text("light_intensities.txt", "1 2 3\n4 5 6\n");
    bytes file;
    make_mat(true, &file);
    assert_int_equal(file_write(scratch_path("Normal_gt.mat"), file.at, file.size), OK);
    merlin_capture c;
    assert_int_equal(pst_capture_read(scratch, NULL, &c), OK);
    assert_int_equal(c.count, 2);
    assert_int_equal(c.lighting, MERLIN_DISTANT_LIGHTS);
    assert_string_equal(c.name[0], "second light.png");
    assert_in_range(pst_code(&c.picture[0], 0), 16383, 16384);
    assert_float_equal(c.light[1].direction[0], 0.6, 1e-6);
    assert_float_equal(c.light[1].intensity[1], 5, 0);
    assert_float_equal(img_at(&c.normal_true, 1, 3)[2], 213, 0);
    pst_capture_free(&c);
    write_text("filenames.txt", "\xef\xbb\xbf" /* as Windows puts before a text */ "001.png\r\nsecond light.png\r\n");
    assert_int_equal(pst_capture_read(scratch, NULL, &c), OK);
    assert_string_equal(c.name[0], "001.png");
    pst_capture_free(&c);
    write_text("filenames.txt", "001.png\n003.png\n");
    assert_int_equal(pst_capture_read(scratch, NULL, &c), MERLIN_BAD_INPUT);
    assert_says("names 003.png");
    write_text("filenames.txt", "001.png\n../001.png\n");
    assert_int_equal(pst_capture_read(scratch, NULL, &c), MERLIN_BAD_INPUT);
    assert_says("not a plain file name");
    write_text("filenames.txt", "001.png\n");
    assert_int_equal(pst_capture_read(scratch, NULL, &c), MERLIN_BAD_INPUT);
    assert_says("names 1 picture, but");
}

static void programs_with_decimal_commas_read_intensities(void **state)
{
    (void)state;
    merlin_capture c;
    write_flat("001.png", 5, 4, 3, 0.5f, IMG_LINEAR16);
    write_flat("002.png", 5, 4, 3, 0.25f, IMG_LINEAR16);
    write_text("filenames.txt", "001.png\n002.png\n");
    write_text("light_directions.txt", "0 0 1\n0.6 0 0.8\n");
    write_text("light_intensities.txt", "1.5 2 3\n4 5 6\n");
    if (!comma_begin(scratch)) return;
    status s = pst_capture_read(scratch, NULL, &c);
    comma_end();
    assert_int_equal(s, OK);
    assert_float_equal(c.light[0].intensity[0], 1.5, 0);
    pst_capture_free(&c);
}

static void a_diligent_folder_needs_no_list_of_names(void **state)
{
    (void)state;
    write_flat("9.png", 5, 4, 3, 0.5f, IMG_LINEAR16);
    write_flat("10.png", 5, 4, 3, 0.25f, IMG_LINEAR16);
    write_flat("Normal_gt.png", 5, 4, 3, 0.5f, IMG_LINEAR8);
    write_text("light_directions.txt", "0 0 1\n0.6 0 0.8\n");
    write_text("light_intensities.txt", "1 2 3\n4 5 6\n");
    assert_true(pst_is_of_data_set(scratch));
    merlin_capture c;
    assert_int_equal(pst_capture_read(scratch, NULL, &c), OK);
    assert_int_equal(c.count, 2);
    assert_string_equal(c.name[1], "10.png");
    assert_float_equal(c.light[1].direction[0], 0.6, 1e-6);
    assert_float_equal(c.light[1].intensity[1], 5, 0);
    pst_capture_free(&c);
    unlink(scratch_path("10.png"));
    assert_int_equal(pst_capture_read(scratch, NULL, &c), MERLIN_BAD_INPUT);
    assert_says("1 picture, but");
    assert_says("light_directions.txt has 2 lights");
    /* another list of lights was meant for this program */
    write_text("lights.txt", "0 0 1\n");
    assert_false(pst_is_of_data_set(scratch));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(matlab_arrays_are_read),
        cmocka_unit_test(numpy_archives_are_read),
        cmocka_unit_test(headers_that_promise_too_much_are_refused),
        cmocka_unit_test(files_cut_anywhere_are_refused),
        cmocka_unit_test(leds_are_turned_into_this_projects_axes),
        cmocka_unit_test(leds_may_end_in_a_number_that_means_nothing),
        cmocka_unit_test(damaged_led_files_are_refused),
        in_scratch(a_luces_folder_is_read_with_its_truth),
        in_scratch(luces_normals_face_the_camera_whatever_their_axes),
        in_scratch(raw_mosaics_of_luces_are_refused),
        in_scratch(a_diligent_folder_is_read_with_its_truth),
        in_scratch(programs_with_decimal_commas_read_intensities),
        in_scratch(a_diligent_folder_needs_no_list_of_names),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
