/* SPDX-License-Identifier: MIT */
/* Forms in which people, spreadsheets and programs write lists of lights; all list the same four directions. */
#include "base/lights/light_list.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { LIGHTS = 4 };
static const float EXPECTED[LIGHTS][3] = {{0.6F, 0, 0.8F}, {0, -0.6F, 0.8F}, {-0.8F, 0, 0.6F}, {0, 0, 1}};

static void assert_same(const light_list *lights, const char *text)
{
    if (lights->count != LIGHTS) fail_msg("%zu lights of \"%s\"", lights->count, text);
    for (size_t i = 0; i < LIGHTS; i++) {
        vec3 d = lights->at[i];
        const float *e = EXPECTED[i];
        /* angles are rounded to 5 digits */
        if (fabsf(d.x - e[0]) > 1e-5f || fabsf(d.y - e[1]) > 1e-5f || fabsf(d.z - e[2]) > 1e-5f)
            fail_msg("light %zu of \"%s\" is %g %g %g", i + 1, text, (double)d.x, (double)d.y, (double)d.z);
    }
}

/* Asserts that the bytes are read as the same four directions, without names, intensities and notes. */
static void assert_reads_bytes(const char *text, size_t size)
{
    light_list lights;
    if (light_list_parse(text, size, "lights.txt", &lights) != OK)
        fail_msg("\"%s\" is refused: %s", text, status_message());
    assert_same(&lights, text);
    if (lights.note[0]) fail_msg("\"%s\" is noted: %s", text, lights.note);
    assert_null(lights.intensity);
    light_list_free(&lights);
}

static void assert_reads(const char *text)
{
    assert_reads_bytes(text, strlen(text));
}

static void assert_names(const char *text, const char *first, const char *last)
{
    light_list lights;
    if (light_list_parse(text, strlen(text), "lights.txt", &lights) != OK)
        fail_msg("\"%s\" is refused: %s", text, status_message());
    assert_same(&lights, text);
    if (!lights.name) fail_msg("no names in \"%s\"", text);
    assert_string_equal(lights.name[0], first);
    assert_string_equal(lights.name[LIGHTS - 1], last);
    assert_null(lights.intensity);
    light_list_free(&lights);
}

static void assert_refused(const char *text, const char *words)
{
    light_list lights;
    assert_int_equal(light_list_parse(text, strlen(text), "lights.txt", &lights), MERLIN_BAD_INPUT);
    assert_null(lights.at);
    if (!strstr(status_message(), words)) fail_msg("\"%s\" does not say \"%s\"", status_message(), words);
    assert_null(strchr(status_message(), '\n'));
}

static void numbers_are_parted_by_anything(void **state)
{
    (void)state;
    assert_reads("0.6 0 0.8\n0 -0.6 0.8\n-0.8 0 0.6\n0 0 1\n");
    assert_reads("0.6,0,0.8\n0,-0.6,0.8\n-0.8,0,0.6\n0,0,1\n");
    assert_reads("0.6, 0, 0.8,\n0, -0.6, 0.8,\n-0.8, 0, 0.6,\n0, 0, 1,\n");
    assert_reads("0.6;0;0.8\n0;-0.6;0.8\n-0.8;0;0.6\n0;0;1");
    assert_reads("0.6;0;0.8;\n0;-0.6;0.8;;\n-0.8; 0 ;0.6;\n0 ; 0 ; 1\n");
    assert_reads("0.6\t0\t0.8\n0\t-0.6\t0.8\n-0.8\t0\t0.6\n0\t0\t1\t\n");
    assert_reads("  0.6   0    0.8   \n\t0 -0.6 \t 0.8\n-0.8 0 0.6\n0 0 1");
    assert_reads("+6.000000000000000000e-01 0.0E+00 .8\n0. -.6 0.8\n-8D-1 0 0.6\n0 0 1.\n");
    assert_reads("   6.0000000e-01   0.0000000e+00   8.0000000e-01\n   0.0000000e+00  -6.0000000e-01   "
                 "8.0000000e-01\n  -8.0000000e-01   0.0000000e+00   6.0000000e-01\n   0   0   1\n");
}

static void commas_may_be_decimal(void **state)
{
    (void)state;
    assert_reads("0,6;0;0,8\n0;-0,6;0,8\n-0,8;0;0,6\n0;0;1\n");
    assert_reads("0,6;0,0;0,8\n0,0;-0,6;0,8\n-0,8;0,0;0,6\n0,0;0,0;1,0\n");
    assert_reads("0,6 0,0 0,8\n0,0 -0,6 0,8\n-0,8 0,0 0,6\n0,0 0,0 1,0\n");
    assert_reads("0,6\t0\t0,8\n0\t-0,6\t0,8\n-0,8\t0\t0,6\n0\t0\t1\n");
    assert_reads("0,6, 0,0, 0,8\n0,0, -0,6, 0,8\n-0,8, 0,0, 0,6\n0,0, 0,0, 1,0\n");
    assert_reads("\"0,6\",\"0\",\"0,8\"\n\"0\",\"-0,6\",\"0,8\"\n\"-0,8\",\"0\",\"0,6\"\n\"0\",\"0\",\"1\"\n");
    assert_reads("lights:\n  - [0.6, 0, 0.8]\n  - [0, -0.6, 0.8]\n  - [-0.8, 0, 0.6]\n  - [0, 0, 1]\n");
    assert_reads("[0,6; 0; 0,8]\n[0; -0,6; 0,8]\n[-0,8; 0; 0,6]\n[0; 0; 1]\n");
    assert_names("a 1.png;0,6;0;0,8\nb.png;0;-0,6;0,8\nc.png;-0,8;0;0,6\nd.png;0;0;1\n", "a 1.png", "d.png");
    assert_refused("0,6,0,0,0,8\n0,0,-0,6,0,8\n", "write decimal points");
    assert_refused("0,5 0.25 1\n", "write decimal points");
}

static void lines_end_as_on_any_system(void **state)
{
    (void)state;
    assert_reads("0.6 0 0.8\r\n0 -0.6 0.8\r\n-0.8 0 0.6\r\n0 0 1\r\n");
    assert_reads("0.6 0 0.8\r\n0 -0.6 0.8\r\n-0.8 0 0.6\r\n0 0 1\r\n\x1a");
    assert_reads("0.6 0 0.8\r0 -0.6 0.8\r-0.8 0 0.6\r0 0 1\r");
    assert_reads("\xef\xbb\xbf"
                 "0.6 0 0.8\n0 \xe2\x88\x92"
                 "0.6 0.8\n-0.8\xc2\xa0"
                 "0 0.6\n0 0 1");
}

/* Both byte orders are read, with a byte order mark and without. */
static void windows_writes_two_bytes_a_letter(void **state)
{
    (void)state;
    static const char text[] = "0.6 0 0.8\r\n0 -0.6 0.8\r\n-0.8 0 0.6\r\n0 0 1\r\n";
    enum { UNITS = sizeof text - 1 };
    for (int kind = 0; kind < 4; kind++) {
        char bytes[2 * UNITS + 2];
        int big = kind & 1, mark = kind < 2;
        bytes[big] = '\xff';
        bytes[!big] = '\xfe';
        for (size_t i = 0; i < UNITS; i++) {
            bytes[2 * i + 2 + (size_t)big] = text[i];
            bytes[2 * i + 2 + (size_t)!big] = 0;
        }
        assert_reads_bytes(mark ? bytes : bytes + 2, 2 * UNITS + (mark ? 2 : 0));
    }
    light_list lights;
    static const char named[] = "\xff\xfe\xe4\0.\0p\0n\0g\0 \0" /* ä.png, and a character of four bytes */
                                "0\0 \0"
                                "0\0 \0"
                                "1\0\n\0=\xd8\x00\xde.\0p\0n\0g\0 \0"
                                "0\0 \0"
                                "0\0 \0"
                                "1";
    assert_int_equal(light_list_parse(named, sizeof named, "lights.txt", &lights), OK);
    assert_int_equal(lights.count, 2);
    assert_string_equal(lights.name[0], "\xc3\xa4.png");
    assert_string_equal(lights.name[1], "\xf0\x9f\x98\x80.png");
    light_list_free(&lights);
}

static void comments_and_empty_lines_are_skipped(void **state)
{
    (void)state;
    assert_reads("# lights\n\n0.6 0 0.8 # left\n% two\n0 -0.6 0.8 % low\n// three\n-0.8 0 0.6 // far\n; four\n   \n0 0 "
                 "1\n#end\n");
    assert_reads("0.6 0 0.8\n#1 1 1\n0 -0.6 0.8\n  # 1 1 1\n-0.8 0 0.6\n;;;\n0 0 1\n");
}

static void lines_of_words_before_the_lights_are_skipped(void **state)
{
    (void)state;
    static const char *const heads[] = {"x y z\n",
                                        "x,y,z\n",
                                        "lx ly lz\n",
                                        "X;Y;Z\n",
                                        "Light X, Light Y, Light Z\n",
                                        "\"x\",\"y\",\"z\"\n",
                                        "x [mm], y [mm], z [mm]\n",
                                        "dir_x dir_y dir_z\n",
                                        "# x y z\n",
                                        "% Light directions\n",
                                        "Light directions\n",
                                        "Directions of the dome 3\nx\ty\tz\n",
                                        "Lights:\n",
                                        "Light 1\n"};
    for (size_t i = 0; i < sizeof heads / sizeof *heads; i++) {
        char text[256];
        snprintf(text, sizeof text, "%s0.6 0 0.8\n0 -0.6 0.8\n-0.8 0 0.6\n0 0 1\n", heads[i]);
        assert_reads(text);
    }
}

static void headers_name_columns_in_any_order(void **state)
{
    (void)state;
    assert_reads("z,y,x\n0.8,0,0.6\n0.8,-0.6,0\n0.6,0,-0.8\n1,0,0\n");
    assert_names("x,y,z,name\n0.6,0,0.8,a.png\n0,-0.6,0.8,b.png\n-0.8,0,0.6,c.png\n0,0,1,d.png\n", "a.png", "d.png");
    assert_names("id,filename,x,y,z\n7,a 1.png,0.6,0,0.8\n8,b.png,0,-0.6,0.8\n5,c.png,-0.8,0,0.6\n1,d.png,0,0,1\n",
                 "a 1.png", "d.png");
    assert_names("Name;X;Y;Z\n\"a;1.png\";0,6;0;0,8\nb.png;0;-0,6;0,8\nc.png;-0,8;0;0,6\nd.png;0;0;1\n", "a;1.png",
                 "d.png");
    assert_names("# image lx ly lz\na.png 0.6 0 0.8\nb.png 0 -0.6 0.8\nc.png -0.8 0 0.6\nd.png 0 0 1\n", "a.png",
                 "d.png");
    light_list lights;
    static const char more[] = "name,x,exposure,y,z,r,g,b\na.png,1,9,2,3,4,5,6\n";
    assert_int_equal(light_list_parse(more, sizeof more - 1, "lights.csv", &lights), OK);
    assert_float_equal(lights.at[0].y, 2, 0);
    assert_float_equal(lights.intensity[0].z, 6, 0);
    assert_string_equal(lights.note, "its column \"exposure\" is not used");
    light_list_free(&lights);
    assert_refused("y,x,z\n1,2\n", "lights.txt:1: the header has 3 columns");
}

static void rows_may_stand_in_brackets(void **state)
{
    (void)state;
    assert_reads("[0.6 0 0.8]\n[0 -0.6 0.8]\n[-0.8 0 0.6]\n[0 0 1]\n");
    assert_reads("(0.6, 0, 0.8)\n(0, -0.6, 0.8)\n(-0.8, 0, 0.6)\n(0, 0, 1)\n");
    assert_reads("{0.6f, 0.f, 0.8f},\n{0, -0.6f, 0.8f},\n{-0.8f, 0, 0.6f},\n{0, 0, 1}\n");
    assert_reads("[[0.6, 0, 0.8], [0, -0.6, 0.8], [-0.8, 0, 0.6], [0, 0, 1]]");
    assert_reads("[[ 0.6  0.   0.8]\n [ 0.  -0.6  0.8]\n [-0.8  0.   0.6]\n [ 0.   0.   1. ]]\n");
    assert_reads(
        "array([[ 0.6,  0. ,  0.8],\n       [ 0. , -0.6,  0.8],\n       [-0.8,  0. ,  0.6],\n       [ 0. ,  0. "
        ",  1. ]], dtype=float32)\n");
    assert_reads("L = [0.6 0 0.8; 0 -0.6 0.8; -0.8 0 0.6; 0 0 1];");
    assert_reads("L = [0.6,0,0.8;0,-0.6,0.8;-0.8,0,0.6;0,0,1];\n");
    assert_reads("L = [\n 0.6 0 0.8\n 0 -0.6 0.8\n -0.8 0 0.6\n 0 0 1\n];\n");
    assert_reads("float lights[4][3] = {{0.6f, 0, 0.8f}, {0, -0.6f, 0.8f},\n {-0.8f, 0, 0.6f}, {0, 0, 1}};\n");
    assert_reads("(0.6,0,0.8) (0,-0.6,0.8) (-0.8,0,0.6) (0,0,1)\n");
    assert_names("a.png (0.6,0,0.8)\nb.png (0,-0.6,0.8)\nc.png (-0.8,0,0.6)\nd (1).png (0,0,1)\n", "a.png",
                 "d (1).png");
    assert_names("[0.6 0 0.8] a.png\n[0 -0.6 0.8] b.png\n[-0.8 0 0.6] c.png\n[0 0 1] d.png\n", "a.png", "d.png");
    assert_names("{\"a.png\": [0.6, 0, 0.8], \"b.png\": [0, -0.6, 0.8],\n\"c.png\": [-0.8, 0, 0.6], \"d.png\": [0, 0, "
                 "1]}\n",
                 "a.png", "d.png");
}

static void names_stand_before_or_behind(void **state)
{
    (void)state;
    assert_names("a.png 0.6 0 0.8\nb.png 0 -0.6 0.8\nc.png -0.8 0 0.6\nd.png 0 0 1\n", "a.png", "d.png");
    assert_names("0.6 0 0.8 a.png\n0 -0.6 0.8 b.png\n-0.8 0 0.6 c.png\n0 0 1 my d.png\n", "a.png", "my d.png");
    assert_names("\"a 1.png\" 0.6 0 0.8\n'b.png' 0 -0.6 0.8\n\"c\" -0.8 0 0.6\n\"d 2\" 0 0 1\n", "a 1.png", "d 2");
    assert_names("a 1.png,0.6,0,0.8\nb.png,0,-0.6,0.8\nc,-0.8,0,0.6\nD:\\my set\\d 2.JPG,0,0,1\n", "a 1.png",
                 "D:\\my set\\d 2.JPG");
    assert_names("C:\\a\\b.jpg 0.6 0 0.8\nb.jpg 0 -0.6 0.8\nc.jpg -0.8 0 0.6\nIMG (2).jpg 0 0 1\n", "C:\\a\\b.jpg",
                 "IMG (2).jpg");
    assert_names("a.png: 0.6 0 0.8\nb.png: 0 -0.6 0.8\nc.png: -0.8 0 0.6\nd.png : 0 0 1\n", "a.png", "d.png");
    assert_names("it's a.png 0.6 0 0.8\nb.png 0 -0.6 0.8\nc.png -0.8 0 0.6\n100% d.png 0 0 1\n", "it's a.png",
                 "100% d.png");
    assert_names("4\na.png 0.6 0 0.8\nb.png 0 -0.6 0.8\nc.png -0.8 0 0.6\nd.png 0 0 1\n", "a.png", "d.png");
    assert_names("dome of 2019\n4\na 0.6 0 0.8\nb 0 -0.6 0.8\nc -0.8 0 0.6\nd 0 0 1\n", "a", "d");
    assert_refused("a.png 0 0 1\n0 1 1\n", "lights.txt:2: no name");
    assert_refused("a.png 0 0 1\n0 1 1 b.png\n", "lights.txt:2");
}

static void numbers_of_lights_are_no_numbers_of_places(void **state)
{
    (void)state;
    assert_names("1 0.6 0 0.8\n2 0 -0.6 0.8\n3 -0.8 0 0.6\n4 0 0 1\n", "1", "4");
    assert_names("0,0.6,0,0.8\n1,0,-0.6,0.8\n2,-0.8,0,0.6\n3,0,0,1\n", "0", "3");
    assert_names("1;0,6;0;0,8\n2;0;-0,6;0,8\n3;-0,8;0;0,6\n4;0;0;1\n", "1", "4");
    assert_names("5 0.6 0 0.8\n6 0 -0.6 0.8\n7 -0.8 0 0.6\n8 0 0 1\n", "5", "8");
    assert_names("0 0.6 0 0.8\n15 0 -0.6 0.8\n45 -0.8 0 0.6\n30 0 0 1\n", "0", "30");
    assert_names("0.6 0 0.8 2\n0 -0.6 0.8 1\n-0.8 0 0.6 3\n0 0 1 4\n", "2", "4");
    assert_names("Light 1 0.6 0 0.8\nLight 2 0 -0.6 0.8\nLight 3 -0.8 0 0.6\nLight 4 0 0 1\n", "Light 1", "Light 4");
    assert_names("Light 1: 0.6, 0, 0.8\nLight 2: 0, -0.6, 0.8\nLight 3: -0.8, 0, 0.6\nLight 4: 0, 0, 1\n", "Light 1",
                 "Light 4");
    assert_names("1 0.6 0 0.8 a.png\n2 0 -0.6 0.8 b.png\n3 -0.8 0 0.6 c.png\n4 0 0 1 d.png\n", "a.png", "d.png");
    assert_names("a.png 1 0.6 0 0.8\nb.png 2 0 -0.6 0.8\nc.png 3 -0.8 0 0.6\nd.png 4 0 0 1\n", "a.png", "d.png");
}

static void lights_may_stand_in_columns(void **state)
{
    (void)state;
    assert_reads("0.6 0 -0.8 0\n0 -0.6 0 0\n0.8 0.8 0.6 1\n");
    assert_reads("0.6,0,-0.8,0\n0,-0.6,0,0\n0.8,0.8,0.6,1\n");
    assert_reads("0,6 0 -0,8 0\n0 -0,6 0 0\n0,8 0,8 0,6 1\n");
    assert_reads("L = [0.6 0 -0.8 0; 0 -0.6 0 0; 0.8 0.8 0.6 1];");
    assert_reads("[[0.6, 0, -0.8,\n 0], [0, -0.6, 0, 0],\n [0.8, 0.8, 0.6, 1]]\n");
    assert_reads("x 0.6 0 -0.8 0\ny 0 -0.6 0 0\nz 0.8 0.8 0.6 1\n");
    assert_reads("Light 1,Light 2,Light 3,Light 4\n0.6,0,-0.8,0\n0,-0.6,0,0\n0.8,0.8,0.6,1\n");
    light_list lights;
    static const char seven[] = "1 2 3 4 5 6 70\n1 2 3 4 5 6 80\n1 2 3 4 5 6 90\n";
    assert_int_equal(light_list_parse(seven, sizeof seven - 1, "l.txt", &lights), OK);
    assert_int_equal(lights.count, 7);
    assert_float_equal(lights.at[6].y, 80, 0);
    light_list_free(&lights);
    /* three lines of three numbers are one light a line, as documented; a note says that they could be read otherwise
     */
    static const char three[] = "0.6 0 -0.8\n0 -0.6 0\n0.8 0.8 0.6\n";
    assert_int_equal(light_list_parse(three, sizeof three - 1, "l.txt", &lights), OK);
    assert_float_equal(lights.at[0].z, -0.8, 1e-6);
    assert_non_null(strstr(lights.note, "columns"));
    light_list_free(&lights);
    assert_refused("1 2 3 4\n5 6 7 8\n9 1 2 3\n", "3 lights with strengths or 4 lights in columns");
}

static void strengths_stand_behind_directions(void **state)
{
    (void)state;
    light_list lights;
    static const struct {
        const char *text;
        float red, blue;
    } cases[] = {{"0 0 1 2.5\n0 1 0 0.5\n", 2.5F, 2.5F},           {"0 0 1 2 3 4\n0 1 0 1 1 1\n", 2, 4},
                 {"a.png 0 0 1 2 3 4\nb.png 0 1 0 1 1 1\n", 2, 4}, {"2\na.png 0 0 1 2\nb.png 0 1 0 1\n", 2, 2},
                 {"0 0 1 2 3 4 a.png\n0 1 0 1 1 1 b.png\n", 2, 4}, {"1 0 0 1 2 3 4\n2 0 1 0 1 1 1\n", 2, 4},
                 {"0 0 1,5 2,5\n0 1 0 0,5\n", 2.5F, 2.5F}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const char *text = cases[i].text;
        if (light_list_parse(text, strlen(text), "l.txt", &lights) != OK) fail_msg("%s: %s", text, status_message());
        assert_int_equal(lights.count, 2);
        assert_float_equal(lights.at[1].y, 1, 0);
        assert_float_equal(lights.intensity[0].x, cases[i].red, 0);
        assert_float_equal(lights.intensity[0].z, cases[i].blue, 0);
        assert_non_null(strstr(lights.note, "strength"));
        light_list_free(&lights);
    }
    const char *red = "0 0 1 2 0 0\n0 1 0 0 0 0.5\n"; /* coloured LEDs */
    assert_int_equal(light_list_parse(red, strlen(red), "l.txt", &lights), OK);
    assert_float_equal(lights.intensity[0].x, 2, 0);
    assert_float_equal(lights.intensity[0].y, 0, 0);
    light_list_free(&lights);
    assert_refused("0 0 1 1 1 1\n0 1 0 0 0 0\n", "lights.txt:2: the light is black");
    assert_refused("0 0 1 0\n0 1 0 1\n", "lights.txt:1: an intensity must be above zero");
    assert_refused("0 0 1 -1 2 2\n0 1 0 1 1 1\n", "lights.txt:1: an intensity");
    assert_refused("0 0 1 1 1\n0 1 0 1 1\n", "found 5 words");
}

static void angles_want_a_header(void **state)
{
    (void)state;
    assert_reads("azimuth deg, elevation deg\n0, 53.130102\n270, 53.130102\n180, 36.869898\n12, 90\n");
    assert_reads("Elevation (deg);Azimuth (deg)\n53,130102;0\n53,130102;-90\n36,869898;180\n90;0\n");
    assert_reads("az[rad] el[rad]\n0 0.9272952\n-1.5707963 0.9272952\n3.1415927 0.6435011\n0 1.5707963\n");
    assert_reads(
        "azimuth_degrees elevation_degrees distance\n0 53.130102 1\n270 53.130102 1\n180 36.869898 1\n12 90 1\n");
    assert_names("name,azimuth (°),elevation (°)\na,0,53.130102\nb,270,53.130102\nc,180,36.869898\nd,12,90\n", "a",
                 "d");
    light_list lights;
    static const char far[] = "azimuth deg, elevation deg, distance\n90, 0, 2\n";
    assert_int_equal(light_list_parse(far, sizeof far - 1, "l.txt", &lights), OK);
    assert_float_equal(lights.at[0].y, 2, 1e-6);
    assert_false(lights.angles);
    light_list_free(&lights);
    assert_refused("45 30\n90 60\n", "azimuth deg");
    assert_refused("azimuth,elevation\n45,30\n", "no unit");
    assert_refused("azimuth rad,elevation rad\n45,30\n", "beyond a whole turn");
    assert_refused("theta deg,phi deg\n45,30\n", "counted in several ways");
}

static void what_no_light_can_be_is_refused_by_its_line(void **state)
{
    (void)state;
    assert_refused("0 0 1\n\n# x\n0 NaN 1\n", "lights.txt:4: \"NaN\"");
    assert_refused("x,y,z\n0,0,1\n0,-inf,1\n", "lights.txt:3: \"-inf\"");
    assert_refused("0 0 1\r0 0 1e40\r", "lights.txt:2: \"1e40\"");
    assert_refused("2\na.png 0 0 1\nb.png 0 0 0\n", "lights.txt:3: the direction has no length");
    assert_refused("0 0 1\n1 O.5 1\n", "lights.txt:2: \"O.5\" is not a finite number");
    assert_refused("0 0 1\n0 0\n", "lights.txt:2: expected x y z");
    assert_refused("0 0 1\nhere the dome is turned\n", "lights.txt:2: expected x y z, found 5 words");
    assert_refused("3\na.png 0 0 1\nb.png 0 1 1\n",
                   "the first line says 3 lights, but there are 2, the last one for b.png: correct that number");
    assert_refused("0.5\n0 0 1\n", "lights.txt:1: expected x y z or a count");
    assert_refused("[[0,0,1],\n[0,1,0],\n[0,nan,0]]", "lights.txt:3: \"nan\"");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(numbers_are_parted_by_anything),
        cmocka_unit_test(commas_may_be_decimal),
        cmocka_unit_test(lines_end_as_on_any_system),
        cmocka_unit_test(windows_writes_two_bytes_a_letter),
        cmocka_unit_test(comments_and_empty_lines_are_skipped),
        cmocka_unit_test(lines_of_words_before_the_lights_are_skipped),
        cmocka_unit_test(headers_name_columns_in_any_order),
        cmocka_unit_test(rows_may_stand_in_brackets),
        cmocka_unit_test(names_stand_before_or_behind),
        cmocka_unit_test(numbers_of_lights_are_no_numbers_of_places),
        cmocka_unit_test(lights_may_stand_in_columns),
        cmocka_unit_test(strengths_stand_behind_directions),
        cmocka_unit_test(angles_want_a_header),
        cmocka_unit_test(what_no_light_can_be_is_refused_by_its_line),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
