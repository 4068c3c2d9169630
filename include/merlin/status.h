/* SPDX-License-Identifier: MIT */
/* merlin/status: how functions say what went wrong, and what holds for the whole library (merlin.h). */
#ifndef MERLIN_STATUS_H
#define MERLIN_STATUS_H

#ifdef __cplusplus
extern "C" {
#endif

typedef enum merlin_status {
    MERLIN_OK = 0,
    MERLIN_WRONG_USE, /* the call makes no sense: sizes that do not fit, values out of range */
    MERLIN_BAD_INPUT, /* a file or its content is missing, damaged or of another kind */
    MERLIN_CANNOT_WRITE,
    MERLIN_NO_MEMORY,
    MERLIN_DEVICE_FAILED,
    MERLIN_STOPPED, /* params.stop said so */
} merlin_status;

/* The message of this thread's last failure. Valid until the next call in this thread. */
const char *merlin_error(void);

/* Of the library that runs, "0.1.0". Before 1.0 another minor version is another library (soname). */
const char *merlin_version(void);

/* How many threads work for each that calls the library, from its next call on: 1 to 1024, or as many of them as can be
 * had. Without it OMP_NUM_THREADS, else one a processor. */
merlin_status merlin_set_threads(int count);

/* Hears how far long work is, as a params' `progress`: the stage of the work, such as "estimating", and the share of it
 * that is done, in [0, 1]. Called by the thread that called the library, with the params' progress_context. */
typedef void (*merlin_progress)(void *context, const char *stage, float share);

#ifdef __cplusplus
}
#endif

#endif
