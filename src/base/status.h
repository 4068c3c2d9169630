/* SPDX-License-Identifier: MIT */
/* How functions report failure.
 *
 * A function that can fail returns a status. The words for a person (what, where, what to do) are kept per thread and
 * read once by whoever stops the work:
 *
 *     status s = exr_read(path, &maps);
 *     if (s != OK) return fail_in(s, "cannot read maps from %s", path);
 *     ...
 *     fprintf(stderr, "merlin: %s\n", status_message());
 */
#ifndef MERLIN_BASE_STATUS_H
#define MERLIN_BASE_STATUS_H

#include "merlin/status.h"

/* The library's own status, by a short name for the inside. */
typedef merlin_status status;

#define OK MERLIN_OK
/* Another process of the same work has failed, and says why (base/ranks/ranks.h). No public function returns it. */
#define STATUS_ELSEWHERE ((status)(MERLIN_STOPPED + 1))

/* Records the message and returns s. */
status fail(status s, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Puts a context in front of the message of the failure being passed on ("context: message") and returns s. */
status fail_in(status s, const char *format, ...) __attribute__((format(printf, 2, 3)));

#ifdef __clang_analyzer__
/* Static analysis does not see into status.c: here it learns that a failure is never OK. */
static inline status status_given(status s, status recorded)
{
    (void)recorded;
    return s;
}
#define fail(s, ...) status_given(s, fail(s, __VA_ARGS__))
#define fail_in(s, ...) status_given(s, fail_in(s, __VA_ARGS__))
#endif

/* The message of this thread's last failure; "" if there was none. Valid until the next fail in this thread. */
const char *status_message(void);

#endif
