/* SPDX-License-Identifier: MIT */
/* Memory that runs out at the n-th allocation.
 *
 *     failing_memory_count();            what(); calls = failing_memory_end();
 *     failing_memory_begin(3, false);    what(); failing_memory_end();           its third allocation fails, no other
 *
 * A program that is linked with this has its own malloc, calloc, realloc, strdup, strndup and mmap in front of the
 * system's. Those calls count that stand in the program itself, which is linked with the project's static libraries,
 * and those of the libraries in C that report lack of memory to who called them: libc, cJSON, libpng, libjpeg,
 * libdeflate, OpenEXR Core, FreeType, zlib, CHOLMOD. The others', which throw or end the program (oneDNN, OpenMP,
 * libvips), never fail. */
#ifndef MERLIN_TESTS_FAILING_MEMORY_H
#define MERLIN_TESTS_FAILING_MEMORY_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Whose calls count from the next count or begin on: those of the libraries, too (at first), or the program's alone,
 * which is for pictures that libvips decodes, by the same libraries. */
void failing_memory_of_libraries(bool theirs_too);

/* Counts allocations of all threads, none of which fails, from 1 on. */
void failing_memory_count(void);
/* The n-th fails, and all behind it if so said. */
void failing_memory_begin(size_t n, bool and_all_behind);
/* Nothing fails from here on. Returns how many allocations there were since count or begin. */
size_t failing_memory_end(void);

/* By which way through the program the n-th of what was last counted was reached: the same number for the same calls.
 */
uint64_t failing_memory_way(size_t n);
/* Prints that way to standard error, for addr2line. */
void failing_memory_print_way(size_t n);

#endif
