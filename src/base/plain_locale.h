/* SPDX-License-Identifier: MIT */
/* The C locale, for numbers in files: they have a decimal point, whatever locale the program has set.
 *
 *     float x = strtof_l(word, &end, plain_locale());
 *
 *     locale_t before = uselocale(plain_locale());
 *     fprintf(f, "%g\n", x);
 *     uselocale(before);
 */
#ifndef MERLIN_BASE_PLAIN_LOCALE_H
#define MERLIN_BASE_PLAIN_LOCALE_H

#include <locale.h>

/* Returns the C locale; may be called from any thread. */
locale_t plain_locale(void);

#endif
