/* SPDX-License-Identifier: MIT */
#include "command/suggest.h"

#include <string.h>

#include "base/number.h"

enum { LONGEST = 32 }; /* letters of a name */

/* Returns the distance of Damerau and Levenshtein in which no letter is moved twice ("optimal string alignment"). */
static int slips(const char *a, size_t a_length, const char *b, size_t b_length)
{
    int row[3][LONGEST + 1]; /* last three rows of the table: for a's first i letters */
    for (size_t j = 0; j <= b_length; j++)
        row[0][j] = (int)j;
    for (size_t i = 1; i <= a_length; i++) {
        int *now = row[i % 3];
        const int *before = row[(i + 2) % 3], *earlier = row[(i + 1) % 3];
        now[0] = (int)i;
        for (size_t j = 1; j <= b_length; j++) {
            now[j] = min_int(min_int(before[j], now[j - 1]) + 1, before[j - 1] + (a[i - 1] != b[j - 1]));
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                now[j] = min_int(now[j], earlier[j - 2] + 1);
        }
    }
    return row[a_length % 3][b_length];
}

const char *suggest(const char *word, size_t length, const char *const *names, size_t count)
{
    const char *nearest = NULL;
    if (length == 0 || length > LONGEST) return NULL;
    int fewest = 1 + (int)(length < 3 ? 1 : length / 3);
    for (size_t i = 0; i < count; i++) {
        size_t name_length = strlen(names[i]);
        int apart = name_length > LONGEST ? fewest : slips(word, length, names[i], name_length);
        if (apart >= fewest || apart >= (int)name_length) continue;
        fewest = apart;
        nearest = names[i];
    }
    return nearest;
}
