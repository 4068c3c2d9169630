/* SPDX-License-Identifier: MIT */
#include "stereo/capture/plane.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

/* Number of different codes. */
enum { CODES = UINT16_MAX + 1 };

/* Notes which codes occur. Returns false once they are too many for a byte, beside 0. */
static bool list_codes(const uint16_t *codes, size_t count, bool occurs[CODES])
{
    size_t different = 1;
    occurs[0] = true;
    for (size_t i = 0; i < count; i++) {
        if (occurs[codes[i]]) continue;
        occurs[codes[i]] = true;
        if (++different > PST_PLANE_FEW) return false;
    }
    return true;
}

/* Makes the indices of codes of which few occur. */
static void make_narrow(const uint16_t *codes, size_t count, const bool occurs[CODES], uint8_t *index, pst_plane *out)
{
    size_t different = 0;
    for (size_t code = 0; code < CODES; code++) {
        if (!occurs[code]) continue;
        index[code] = (uint8_t)different;
        out->code[different++] = (uint16_t)code;
    }
    for (size_t i = 0; i < count; i++)
        out->narrow[i] = index[codes[i]];
}

void pst_plane_take(uint16_t *codes, size_t count, pst_plane *out)
{
    *out = (pst_plane){.wide = codes};
    bool *occurs = calloc(CODES, sizeof *occurs);
    uint8_t *index = malloc(CODES * sizeof *index);
    const bool few = occurs && index && list_codes(codes, count, occurs);
    if (few) out->narrow = malloc(count * sizeof *out->narrow);
    if (few && out->narrow) {
        memory_prefer_large_pages(out->narrow, count * sizeof *out->narrow);
        make_narrow(codes, count, occurs, index, out);
        free(codes);
        out->wide = NULL;
    }
    free(occurs);
    free(index);
}

void pst_plane_free(pst_plane *p)
{
    free(p->wide);
    free(p->narrow);
    *p = (pst_plane){0};
}

status pst_plane_widen(pst_plane *p, size_t count)
{
    if (p->wide) return OK;
    uint16_t *codes = malloc(count * sizeof *codes);
    if (!codes) return fail(MERLIN_NO_MEMORY, "no memory for a picture of %zu values", count);
    (void)pst_codes(p, 0, count, codes);
    pst_plane_free(p);
    p->wide = codes;
    return OK;
}

const uint16_t *pst_codes(const pst_plane *p, size_t first, size_t count, uint16_t *buffer)
{
    if (!p->narrow) return p->wide + first;
    for (size_t i = 0; i < count; i++)
        buffer[i] = p->code[p->narrow[first + i]];
    return buffer;
}

bool pst_plane_equals(const pst_plane *a, const pst_plane *b, size_t count)
{
    if (!a->narrow && !b->narrow) return memcmp(a->wide, b->wide, count * sizeof *a->wide) == 0;
    for (size_t i = 0; i < count; i++)
        if (pst_code(a, i) != pst_code(b, i)) return false;
    return true;
}
