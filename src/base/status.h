/* SPDX-License-Identifier: MIT */
/* How functions report failure.
 *
 * A function that can fail returns a status. The message for the user (what, where, what to do) is kept per thread, and
 * read once where the work is stopped:
 *
 *     status s = exr_read(path, &maps);
 *     if (s != OK) return fail_in(s, "cannot read maps from %s", path);
 *     ...
 *     fprintf(stderr, "merlin: %s\n", status_message());
 */
#ifndef MERLIN_BASE_STATUS_H
#define MERLIN_BASE_STATUS_H

#include "merlin/status.h"

/* The library's public status under a short name for internal use. */
typedef merlin_status status;

#define OK MERLIN_OK
/* Status of a rank when another rank of the same work has failed and reports why (base/ranks/ranks.h). No public
 * function returns it. */
#define STATUS_ELSEWHERE ((status)(MERLIN_STOPPED + 1))

/* Records the message and returns s. */
status fail(status s, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Puts context in front of the recorded message ("context: message") and returns s. */
status fail_in(status s, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Puts a shown name in the place of a hidden one in the recorded message and returns s. */
status fail_shown(status s, const char *hidden, const char *shown);

/* Returns MERLIN_NO_MEMORY if errno says that memory ran out, else s, after a refusal by the C library or by a library
 * that uses it and does not report its reason; errno must have been 0 before. */
status status_by_errno(status s);
/* Records the message followed by errno's ("message: No such file or directory"), and returns status_by_errno(s). */
status fail_by_errno(status s, const char *format, ...) __attribute__((format(printf, 2, 3)));

#ifdef __clang_analyzer__
/* Tells static analysis, which does not see into status.c, that a failure is never OK. */
static inline status status_given(status s, status recorded)
{
    (void)recorded;
    return s;
}
#define fail(s, ...) status_given(s, fail(s, __VA_ARGS__))
#define fail_in(s, ...) status_given(s, fail_in(s, __VA_ARGS__))
#define fail_by_errno(s, ...) status_given(s, fail_by_errno(s, __VA_ARGS__))
#define fail_shown(s, ...) status_given(s, fail_shown(s, __VA_ARGS__))
#endif

/* Returns the message of this thread's last failure; "" if there was none. Valid until the thread's next fail. */
const char *status_message(void);

#endif
