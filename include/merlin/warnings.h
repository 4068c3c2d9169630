/* SPDX-License-Identifier: MIT */
/* merlin/warnings: what one should know about a result before trusting it.
 *
 *     for (size_t i = 0; i < surface.warnings.count; i++)
 *         printf("%s: %s\n", surface.warnings.at[i].code, surface.warnings.at[i].message); */
#ifndef MERLIN_WARNINGS_H
#define MERLIN_WARNINGS_H

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { MERLIN_MOST_WARNINGS = 24, MERLIN_WARNING_WORDS = 512 };

typedef struct merlin_warning {
    const char *code;                   /* name for programs, in snake_case, as in reports (docs/json.md) */
    char message[MERLIN_WARNING_WORDS]; /* sentence for a person, without a full stop */
} merlin_warning;

/* Warnings, the most serious first. Nothing in it needs to be freed. */
typedef struct merlin_warnings {
    size_t count; /* number in the list */
    size_t more;  /* number for which it had no room */
    merlin_warning at[MERLIN_MOST_WARNINGS];
} merlin_warnings;

#ifdef __cplusplus
}
#endif

#endif
