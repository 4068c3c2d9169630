/* SPDX-License-Identifier: MIT */
/* The values of one picture of a capture, as 16-bit codes: value = code / 65535. A picture that was read from 8 bits
 * has at most 256 different ones, and is kept in as many bits: sixteen of 24 megapixels are 1.2 GB instead of 2.3.
 *
 *     pst_plane p;
 *     pst_plane_take(codes, count, &p);           malloc'ed, 16 bits each
 *     ... pst_code(&p, i) ...
 *     pst_plane_free(&p);
 */
#ifndef MERLIN_STEREO_CAPTURE_PLANE_H
#define MERLIN_STEREO_CAPTURE_PLANE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/status.h"

enum { PST_PLANE_FEW = 256 };

typedef struct pst_plane {
    uint16_t *wide;               /* the codes; NULL if few differ */
    uint8_t *narrow;              /* their indices in `code`; NULL if many differ */
    uint16_t code[PST_PLANE_FEW]; /* ascending; the first is 0, whether it occurs or not */
} pst_plane;

/* Takes the codes: frees them where a byte each is enough. */
void pst_plane_take(uint16_t *codes, size_t count, pst_plane *out);
void pst_plane_free(pst_plane *p);
/* Makes the codes 16 bits each, for who changes them. MERLIN_NO_MEMORY. */
status pst_plane_widen(pst_plane *p, size_t count);

static inline uint16_t pst_code(const pst_plane *p, size_t i)
{
    return p->narrow ? p->code[p->narrow[i]] : p->wide[i];
}

/* Returns the codes first .. first + count - 1: from the buffer, which has room for them, if they are not stored as
 * such. */
const uint16_t *pst_codes(const pst_plane *p, size_t first, size_t count, uint16_t *buffer);

/* Tells whether two planes have the same codes. */
bool pst_plane_equals(const pst_plane *a, const pst_plane *b, size_t count);

/* Returns where the codes or their indices are stored, and the bytes of each; zeros stand for zero in both. */
static inline char *pst_plane_data(const pst_plane *p)
{
    return p->narrow ? (char *)p->narrow : (char *)p->wide;
}
static inline size_t pst_plane_bytes(const pst_plane *p)
{
    return p->narrow ? sizeof *p->narrow : sizeof *p->wide;
}

#endif
