/* SPDX-License-Identifier: MIT */
/* Measures photometric stereo by least squares: its rate of reading pictures from memory, beside the machine's rate of
 * copying, and the memory that it needs beyond the pictures.
 *
 *     bench_stereo_report report;
 *     status s = bench_stereo(&(bench_stereo_options){.quick = true}, &report);
 *     if (s == OK) bench_stereo_print(&report, stdout);
 */
#ifndef MERLIN_LAB_BENCH_BENCH_STEREO_H
#define MERLIN_LAB_BENCH_BENCH_STEREO_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

#include "base/status.h"

enum { BENCH_STEREO_RUNS = 3 };

typedef struct bench_stereo_run {
    int pictures;
    bool shadows; /* a sixth of every picture is in shadow, a different part in each; else every value counts */
    double seconds;
    size_t input_bytes;   /* size of the pictures */
    size_t working_bytes; /* peak memory beyond them, results included; 0 if the system does not tell */
} bench_stereo_run;

typedef struct bench_stereo_report {
    int threads, width, height, channels;
    double copy_rate;                        /* bytes read and written a second */
    bench_stereo_run run[BENCH_STEREO_RUNS]; /* of few pictures, of many, and of many with shadows */
} bench_stereo_report;

typedef struct bench_stereo_options {
    bool quick; /* 1 megapixel instead of 12, fewer runs */
    bool quiet;
    int (*stopped)(void); /* polled between measurements; NULL: never */
} bench_stereo_options;

status bench_stereo(const bench_stereo_options *options, bench_stereo_report *out);

void bench_stereo_print(const bench_stereo_report *report, FILE *stream);
/* Returns malloc'ed JSON; NULL if memory ran out. */
char *bench_stereo_json(const bench_stereo_report *report);

#endif
