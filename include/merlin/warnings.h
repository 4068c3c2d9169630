/* SPDX-License-Identifier: MIT */
/* merlin/warnings: what should be known of a result before it is trusted.
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
    const char *code;                   /* a name for programs, in snake_case, as in reports (docs/json.md) */
    char message[MERLIN_WARNING_WORDS]; /* a sentence for a person, without a full stop */
} merlin_warning;

/* The gravest come first. Nothing in it is to be freed. */
typedef struct merlin_warnings {
    size_t count; /* those in the list */
    size_t more;  /* those that it had no room for */
    merlin_warning at[MERLIN_MOST_WARNINGS];
} merlin_warnings;

#ifdef __cplusplus
}
#endif

#endif
