/* SPDX-License-Identifier: MIT */
#include "image/read/mask_names.h"

#include <ctype.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

#include "base/file.h"

/* Words for masks, the usual ones first. Without a photograph of their name beside them only the strong ones make a
 * picture a mask. */
static const char *const words[] = {"mask", "masks", "matte", "silhouette", "alpha", "segmentation", "seg", "label"};
enum { WORDS = sizeof words / sizeof *words, STRONG = 4 };

/* Ways to combine a word with a name, the usual ones first. */
enum { BY_DOT = 1, BY_LINE, BY_DASH, BY_SPACE, BY_NOTHING, BEFORE, NUMBERED, FORMS };

/* Part of a name. */
typedef struct part {
    const char *at;
    size_t length;
} part;

static part stem_of(const char *name)
{
    const char *dot = strrchr(name, '.');
    return (part){name, dot && dot > name ? (size_t)(dot - name) : strlen(name)};
}

static bool is_word(part p, const char *word)
{
    return strlen(word) == p.length && strncasecmp(p.at, word, p.length) == 0;
}

static bool is_same(part a, part b)
{
    return a.length == b.length && strncasecmp(a.at, b.at, a.length) == 0;
}

/* Returns the form of a separator after a name; 0 if it is none. */
static int form_of(char separator)
{
    static const char separators[] = "._- ";
    const char *found = separator ? strchr(separators, separator) : NULL;
    return found ? BY_DOT + (int)(found - separators) : 0;
}

static part without_number(part p)
{
    while (p.length > 0 && isdigit((unsigned char)p.at[p.length - 1]))
        p.length--;
    if (p.length > 0 && form_of(p.at[p.length - 1])) p.length--;
    return p;
}

static int find_word(part p)
{
    for (int w = 0; w < WORDS; w++)
        if (is_word(p, words[w])) return w;
    return -1;
}

static int rank_of(int word, int form)
{
    return 1 + word * FORMS + form;
}

/* Ranks a name that is the photograph's with a word after it. */
static int rank_behind(part name, part photo)
{
    if (name.length <= photo.length || strncasecmp(name.at, photo.at, photo.length) != 0) return 0;
    part rest = {name.at + photo.length, name.length - photo.length};
    int form = form_of(*rest.at), word;
    if (form) rest = (part){rest.at + 1, rest.length - 1};
    if ((word = find_word(rest)) >= 0 && (form || word == 0)) return rank_of(word, form ? form : BY_NOTHING);
    word = find_word(without_number(rest));
    return form && word >= 0 ? rank_of(word, NUMBERED) : 0;
}

/* Ranks a name that is the photograph's with a word before it. */
static int rank_before(part name, part photo)
{
    if (name.length <= photo.length + 1) return 0;
    part rest = {name.at + name.length - photo.length, photo.length};
    part word = {name.at, name.length - photo.length - 1};
    int found = find_word(word);
    return found >= 0 && form_of(name.at[word.length]) && is_same(rest, photo) ? rank_of(found, BEFORE) : 0;
}

/* Orders equal ranks: PNG before formats that may be lossy, and the same case before another. */
static int refine(int rank, const char *name, const char *photo, size_t length)
{
    bool other_case = memmem(name, strlen(name), photo, length) == NULL;
    return rank ? 4 * rank + (file_ends_in(name, ".png") ? 0 : 2) + other_case : 0;
}

static int rank_by(part name, part photo)
{
    int rank = rank_behind(name, photo);
    return rank ? rank : rank_before(name, photo);
}

int mask_name_rank(const char *name, const char *photo, bool apart)
{
    part own = stem_of(name), stem = stem_of(photo), whole = {photo, strlen(photo)};
    int rank = rank_by(own, whole);
    if (rank) return refine(rank, name, photo, whole.length);
    rank = rank_by(own, stem);
    if (!rank && apart && is_same(own, whole)) rank = rank_of(WORDS, BY_DOT);
    if (!rank && apart && is_same(own, stem)) rank = rank_of(WORDS, BY_LINE);
    return refine(rank, name, photo, stem.length);
}

static bool is_strong(int word)
{
    return word >= 0 && word < STRONG;
}

bool mask_name_is_whole(const char *name)
{
    return is_strong(find_word(stem_of(name)));
}

/* Returns the last word of a stem, if a separator of this form precedes it. */
static int last_word(part stem, int form)
{
    for (size_t i = stem.length; i > 1; i--) {
        int found = form_of(stem.at[i - 1]);
        if (!found) continue;
        return found == form ? find_word((part){stem.at + i, stem.length - i}) : -1;
    }
    return -1;
}

bool mask_name_is_sure(const char *name)
{
    return last_word(stem_of(name), BY_DOT) == 0;
}

static bool is_likely(part stem)
{
    size_t first = 0;
    for (int form = BY_DOT; form <= BY_SPACE; form++)
        if (is_strong(last_word(stem, form))) return true;
    while (first < stem.length && !form_of(stem.at[first]))
        first++;
    return is_strong(find_word((part){stem.at, first}));
}

bool mask_name_is_likely(const char *name)
{
    part stem = stem_of(name);
    return is_likely(stem) || is_likely(without_number(stem));
}

bool mask_name_has_word(const char *name)
{
    for (int w = 0; w < WORDS; w++)
        if (strcasestr(name, words[w])) return true;
    return false;
}

void mask_names_list(const char *photo, bool apart, char *out, size_t size)
{
    part stem = stem_of(photo);
    int n = (int)stem.length;
    const char *s = stem.at;
    snprintf(out, size, "%.*s.mask.png, %.*s_mask.png, %.*s-mask.png, mask_%.*s.png, %s.mask.png", n, s, n, s, n, s, n,
             s, photo);
    size_t at = strlen(out);
    if (apart && at < size) snprintf(out + at, size - at, ", %.*s.png, %s.png", n, s, photo);
}
