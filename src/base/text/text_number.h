/* SPDX-License-Identifier: MIT */
/* Tells numbers from words in text that people and programs write. */
#ifndef MERLIN_BASE_TEXT_TEXT_NUMBER_H
#define MERLIN_BASE_TEXT_TEXT_NUMBER_H

#include <stdbool.h>
#include <stddef.h>

typedef enum text_kind {
    TEXT_WORD,
    TEXT_NUMBER,
    TEXT_NO_NUMBER /* "nan", "inf" and what exceeds a float */
} text_kind;

/* Classifies a word; *value is its number. With `comma`, a comma may be the decimal point. */
text_kind text_number(const char *word, size_t length, bool comma, double *value);

#endif
