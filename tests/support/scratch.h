/* SPDX-License-Identifier: MIT */
/* Folders for tests to write in, under $TMPDIR or /tmp.
 *
 * One for a test or for a group of them, by cmocka's fixtures:
 *     in_scratch(a_picture_is_written),                          img_write_png(scratch_path("a.png"), ...)
 *     cmocka_run_group_tests(tests, scratch_open, scratch_close)
 * or as many as a test wants:
 *     char *one = scratch_new(), *two = scratch_new();           scratch_remove(one); */
#ifndef MERLIN_TESTS_SCRATCH_H
#define MERLIN_TESTS_SCRATCH_H

extern char *scratch; /* folder between scratch_open and scratch_close */

int scratch_open(void **state);
int scratch_close(void **state);
#define in_scratch(test) cmocka_unit_test_setup_teardown(test, scratch_open, scratch_close)

/* Returns a path in that folder; four are valid at a time, so that a few can be held at once. */
const char *scratch_path(const char *name);

char *scratch_new(void);           /* malloc'ed; aborts if no folder can be made */
void scratch_remove(char *folder); /* removes it with its content; frees the name; may be NULL */

#endif
