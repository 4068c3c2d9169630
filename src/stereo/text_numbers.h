/* Lines of numbers from text, with messages that name the line; what the light files of data sets are made of.
 *
 *     text_numbers t = text_numbers_at(text, size, "light_intensities.txt");
 *     bool found;
 *     status s = text_numbers_next(&t, &found);
 *     if (found) use(t.value, t.count); */
#ifndef MERLIN_STEREO_TEXT_NUMBERS_H
#define MERLIN_STEREO_TEXT_NUMBERS_H

#include <stdbool.h>
#include <stddef.h>

#include "base/file.h"
#include "base/status.h"

enum { TEXT_NUMBERS_MOST = 16 };

typedef struct text_numbers {
    const char *text, *end, *where;
    int line;
    int count; /* numbers on the line; 0: it starts with something else, as headers do */
    double value[TEXT_NUMBERS_MOST];
} text_numbers;

static inline text_numbers text_numbers_at(const char *text, size_t size, const char *where)
{
    return (text_numbers){.text = text + file_text_mark(text, size), .end = text + size, .where = where};
}

/* The next line that is not empty; *found is false at the end. A line that begins with a number must hold finite
 * numbers only, at most TEXT_NUMBERS_MOST, separated by blanks or commas. */
status text_numbers_next(text_numbers *t, bool *found);

#endif
