/* SPDX-License-Identifier: MIT */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "lab/eval/paper/paper_table.h"
#include "lab/eval/paper/paper_table3.h"

#include <cmocka.h> /* last, as cmocka defines a macro named fail */

static void assert_line(const char *text, const char *line)
{
    if (!strstr(text, line)) fail_msg("%s lacks: %s", text, line);
}

static void each_relighter_has_its_rows_and_real_pictures_one(void **state)
{
    (void)state;
    stereo_column column[2] = {{.name = "cup", .pixels = 100}, {.name = "cup", .pixels = 100}};
    for (int i = 0; i < 2; i++)
        for (int row = 0; row < STEREO_ROWS; row++) {
            const bool known = row < STEREO_RELIT_UNIVERSAL && (i == 0 || !stereo_row_is_real((stereo_row)row));
            column[i].row[row].error = known ? 10 * (i + 1) + row : (double)NAN;
            column[i].row[row].spread = 0.25 * (i + 1);
        }
    stereo_table of[] = {{.model = "merlin", .object = &column[0], .count = 1},
                         {.model = "sang", .object = &column[1], .count = 1}};
    const paper3_table t = {.of = of, .count = 2};
    char *text;
    size_t size;
    FILE *stream = open_memstream(&text, &size);
    assert_non_null(stream);
    paper3_table_print(&t, stream);
    fclose(stream);
    assert_line(text, "\n  merlin                10.00    10.00\n  sang                  20.00    20.00\n");
    assert_line(text,
                "\n  by merlin             11.00    11.00\n  by sang               21.00    21.00\n"
                "  real images           12.00    12.00\n  spread of the draws, in the rows' order: 0.25 0.50 0.25\n");
    assert_line(text, "\nuncalibrated\n  by merlin             13.00    13.00\n");
    assert_null(strstr(text, "universal"));
    assert_null(strstr(text, "nan"));
    free(text);
}

static void the_papers_figures_are_those_of_the_row(void **state)
{
    (void)state;
    const char *label;
    const double *row = paper_figures_of(PAPER_TABLE1, "table1-5", &label);
    assert_non_null(row);
    assert_true(row[PAPER_NORMAL] == 3.925 && isnan(row[PAPER_NETWORK]) && row[PAPER_BRDF] == 0.844);
    assert_int_equal(label[0], '5');
    assert_null(paper_figures_of(PAPER_TABLE1, "li", NULL));
    row = paper_figures_of(PAPER_TABLE2, "li", NULL);
    assert_true(row[PAPER_ROUGHNESS] == 19.431 && row[PAPER_BRDF] == 0.884);
    row = paper_figures_of(PAPER_TABLE2, "table1-9", &label);
    assert_string_equal(label, "MERLiN");
    assert_true(row[PAPER_DEPTH] == 0.975);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_relighter_has_its_rows_and_real_pictures_one),
        cmocka_unit_test(the_papers_figures_are_those_of_the_row),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
