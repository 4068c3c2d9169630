/* SPDX-License-Identifier: MIT */
/* Numbers in files have a decimal point, whatever a program that uses the library has told setlocale.
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

/* The C locale; from any thread. */
locale_t plain_locale(void);

#endif
