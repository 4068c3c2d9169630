/* SPDX-License-Identifier: MIT */
/* merlin/status: how functions report errors, and settings of the whole library (merlin.h). */
#ifndef MERLIN_STATUS_H
#define MERLIN_STATUS_H

#ifdef __cplusplus
extern "C" {
#endif

typedef enum merlin_status {
    MERLIN_OK = 0,
    MERLIN_WRONG_USE, /* an impossible call: sizes that do not match, values out of range */
    MERLIN_BAD_INPUT, /* a file or its content is missing, damaged or of another kind */
    MERLIN_CANNOT_WRITE,
    MERLIN_NO_MEMORY,
    MERLIN_DEVICE_FAILED,
    MERLIN_STOPPED, /* params.stop asked to stop */
} merlin_status;

/* Returns the message of this thread's last failure, valid until the next call in this thread. */
const char *merlin_error(void);

/* Returns the running library's version, "0.1.0". Before 1.0 each minor version has another soname. */
const char *merlin_version(void);

/* Sets the number of threads that work for each caller, from its next call on: 1 to 1024, or as many as are available.
 * The default is OMP_NUM_THREADS, else one per processor. */
merlin_status merlin_set_threads(int count);

/* A callback for progress, as a params' `progress`: the stage of the work, such as "estimating", and the share of it
 * that is done, in [0, 1]. It is called by the thread that called the library, with the params' progress_context. */
typedef void (*merlin_progress)(void *context, const char *stage, float share);

#ifdef __cplusplus
}
#endif

#endif
