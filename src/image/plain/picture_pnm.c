/* SPDX-License-Identifier: MIT */
/* netpbm's formats, by its manual (pbm, pgm, ppm, pam and pfm of section 5): P1 to P7, and the floats of PF and Pf. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "image/plain/plain_file.h"

enum { MOST_DIGITS_AFTER = 1 << 16 }; /* spaces and comments before a number */

typedef struct pnm {
    int kind;         /* character after the P */
    unsigned most;    /* code of the value 1 */
    bool big_endian;  /* byte order of floats */
    float unit;       /* factor for floats */
    uint8_t *bytes;   /* a row in the file */
    size_t row_bytes; /* 0 if samples are digits */
} pnm;

static bool is_space(int c)
{
    return c == ' ' || (c >= '\t' && c <= '\r');
}

/* Returns the next character outside spaces and comments; EOF behind the last. */
static int next_solid(plain_file *f)
{
    bool remark = false;
    for (int i = 0; i < MOST_DIGITS_AFTER; i++) {
        int c = getc(f->file);
        if (c == EOF) return EOF;
        if (c == '#') remark = true;
        if (!remark && !is_space(c)) return c;
        if (c == '\n' || c == '\r') remark = false;
    }
    return EOF;
}

/* Reads a whole number of the header or of P2 and P3, and the character after it. Returns false if there is none. */
static bool next_number(plain_file *f, unsigned *out)
{
    const unsigned most = 100000000;
    int c = next_solid(f);
    if (c < '0' || c > '9') return false;
    for (*out = 0; c >= '0' && c <= '9'; c = getc(f->file)) {
        if (*out > most) return false;
        *out = *out * 10 + (unsigned)(c - '0');
    }
    if (c == '#') return ungetc(c, f->file) == c;
    return c == EOF || is_space(c);
}

static bool is_float(const pnm *p)
{
    return p->kind == 'F' || p->kind == 'f';
}

/* Reads samples a pixel, their type, and the size: P1 to P6. */
static bool read_numbers(plain_file *f, pnm *p)
{
    unsigned width, height;
    bool bits = p->kind == '1' || p->kind == '4';
    f->layout.bands = p->kind == '3' || p->kind == '6' ? 3 : 1;
    p->most = 1;
    if (!next_number(f, &width) || !next_number(f, &height) || (!bits && !next_number(f, &p->most))) return false;
    f->layout.width = (int)width;
    f->layout.height = (int)height;
    return p->most >= 1 && p->most <= UINT16_MAX;
}

/* Reads the header of PF and Pf: a number's sign gives the byte order, its size the unit; rows run from the bottom. */
static bool read_float_head(plain_file *f, pnm *p)
{
    char line[64];
    unsigned width, height;
    f->layout.bands = p->kind == 'F' ? 3 : 1;
    f->layout.orientation = 4;
    if (!next_number(f, &width) || !next_number(f, &height) || !fgets(line, sizeof line, f->file)) return false;
    f->layout.width = (int)width;
    f->layout.height = (int)height;
    char *end;
    float scale = strtof(line, &end);
    p->big_endian = scale > 0;
    p->unit = fabsf(scale);
    return end > line && strchr(line, '\n') && isfinite(scale) && p->unit > 0;
}

typedef struct pam_head {
    unsigned width, height, depth, most;
    bool alpha, known;
} pam_head;

static bool take_pam_line(const char *line, pam_head *head)
{
    static const struct {
        const char *name;
        size_t at;
    } numbers[] = {{"WIDTH", offsetof(pam_head, width)},
                   {"HEIGHT", offsetof(pam_head, height)},
                   {"DEPTH", offsetof(pam_head, depth)},
                   {"MAXVAL", offsetof(pam_head, most)}};
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++) {
        size_t n = strlen(numbers[i].name);
        unsigned value;
        if (strncmp(line, numbers[i].name, n) != 0 || sscanf(line + n, " %9u", &value) != 1) continue;
        memcpy((char *)head + numbers[i].at, &value, sizeof value);
        return true;
    }
    if (strncmp(line, "TUPLTYPE", 8) != 0) return line[0] == '#' || line[strspn(line, " \t\r\n")] == 0;
    head->known = true;
    head->alpha = strstr(line, "_ALPHA") != NULL;
    return true;
}

static bool read_pam_head(plain_file *f, pnm *p)
{
    enum { MOST_LINES = 256 };
    char line[256];
    pam_head head = {.width = 0};
    for (int i = 0;; i++) {
        if (i == MOST_LINES || !fgets(line, sizeof line, f->file) || !strchr(line, '\n')) return false;
        if (strncmp(line, "ENDHDR", 6) == 0) break;
        if (!take_pam_line(line, &head)) return false;
    }
    f->layout.width = (int)head.width;
    f->layout.height = (int)head.height;
    f->layout.alpha = head.known ? head.alpha : head.depth == 2 || head.depth == 4;
    f->layout.bands = head.depth <= 4 ? (int)head.depth : 0;
    p->most = head.most;
    int colours = f->layout.bands - f->layout.alpha;
    return (colours == 1 || colours == 3) && head.most >= 1 && head.most <= UINT16_MAX;
}

static bool read_head(plain_file *f, pnm *p)
{
    char mark[2];
    if (!plain_get(f, mark, 2)) return false;
    p->kind = (unsigned char)mark[1];
    p->unit = 1;
    return p->kind == '7' ? getc(f->file) == '\n' && read_pam_head(f, p)
           : is_float(p)  ? read_float_head(f, p)
                          : read_numbers(f, p);
}

static status pnm_open(plain_file *f, void **state)
{
    pnm *p = calloc(1, sizeof *p);
    *state = p;
    if (!p) return fail(MERLIN_NO_MEMORY, "no memory to read %s", f->path);
    if (!read_head(f, p)) return plain_damaged(f);
    size_t samples = (size_t)f->layout.width * (size_t)f->layout.bands;
    bool wide = p->most > UINT8_MAX;
    f->bits = is_float(p) ? 32 : wide ? 16 : 8;
    f->layout.sample = is_float(p)                            ? PICTURE_FLOAT
                       : p->most == UINT8_MAX || p->most == 1 ? PICTURE_UINT8
                                                              : PICTURE_UINT16;
    p->row_bytes = p->kind < '4' ? 0 : p->kind == '4' ? (samples + 7) / 8 : samples * (is_float(p) ? 4 : wide ? 2 : 1);
    bool digits = p->row_bytes == 0;
    status s = plain_check(f, (double)(digits ? samples : p->row_bytes) * f->layout.height);
    if (s != OK || digits) return s;
    p->bytes = malloc(p->row_bytes);
    return p->bytes ? OK : fail(MERLIN_NO_MEMORY, "no memory to read %s", f->path);
}

/* Reads the next code; the digits of P1 need no spaces between them. */
static bool next_code(plain_file *f, const pnm *p, size_t i, unsigned *code)
{
    switch (p->kind) {
    case '1':
        *code = (unsigned)(next_solid(f) - '0');
        return *code <= 1;
    case '2':
    case '3':
        return next_number(f, code);
    case '4':
        *code = p->bytes[i / 8] >> (7 - i % 8) & 1;
        return true;
    default:
        *code = p->most > UINT8_MAX ? (unsigned)p->bytes[2 * i] << 8 | p->bytes[2 * i + 1] : p->bytes[i];
        return true;
    }
}

/* Reads a row's codes; in PBM 1 is black. */
static bool take_codes(plain_file *f, const pnm *p, size_t count, void *samples)
{
    bool inverted = p->kind == '1' || p->kind == '4';
    for (size_t i = 0; i < count; i++) {
        unsigned code;
        if (!next_code(f, p, i, &code) || code > p->most) return false;
        if (inverted) code = 1 - code;
        if (f->layout.sample == PICTURE_UINT8)
            ((uint8_t *)samples)[i] = (uint8_t)(code * (UINT8_MAX / p->most));
        else
            ((uint16_t *)samples)[i] = (uint16_t)((code * (uint64_t)UINT16_MAX + p->most / 2) / p->most);
    }
    return true;
}

static void take_floats(const pnm *p, size_t count, float *samples)
{
    for (size_t i = 0; i < count; i++) {
        const uint8_t *b = p->bytes + 4 * i;
        uint32_t code = p->big_endian ? (uint32_t)b[0] << 24 | (uint32_t)b[1] << 16 | (uint32_t)b[2] << 8 | b[3]
                                      : plain_little32(b);
        memcpy(&samples[i], &code, sizeof code);
        samples[i] *= p->unit;
    }
}

static bool pnm_row(plain_file *f, void *state, void *samples)
{
    pnm *p = state;
    size_t count = (size_t)f->layout.width * (size_t)f->layout.bands;
    if (p->row_bytes && !plain_get(f, p->bytes, p->row_bytes)) return false;
    if (is_float(p))
        take_floats(p, count, samples);
    else
        return take_codes(f, p, count, samples);
    return true;
}

static void pnm_close(void *state)
{
    pnm *p = state;
    if (p) free(p->bytes);
    free(p);
}

const plain_format plain_pnm = {pnm_open, pnm_row, pnm_close};
