/* SPDX-License-Identifier: MIT */
/* The format is PKWARE's APPNOTE.TXT 6.3.10: for each file a header and its bytes, then a directory and its end. */
#include "serve/jobs/archive.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <zlib.h>

enum { BLOCK = 256 << 10, LOCAL = 30, CENTRAL = 46, END = 22, MOST_NAME = 256 };

typedef struct archive {
    int out;
    uint64_t at; /* bytes that are written */
    unsigned char *block;
} archive;

/* Facts of a file that stand in front of it and in the directory. */
typedef struct entry {
    uint32_t crc, size, at;
} entry;

static unsigned char *put(unsigned char *to, uint32_t value, int bytes)
{
    for (int i = 0; i < bytes; i++)
        *to++ = (unsigned char)(value >> 8 * i);
    return to;
}

static status write_all(archive *a, const void *data, size_t size)
{
    const char *from = data;
    a->at += size;
    while (size) {
        const ssize_t done = write(a->out, from, size);
        if (done < 0 && errno == EINTR) continue;
        if (done <= 0) return fail_by_errno(MERLIN_CANNOT_WRITE, "the server cannot make an archive");
        from += done;
        size -= (size_t)done;
    }
    return OK;
}

/* The fields that both headers of a file share: from the version that is needed to the length of its name. Names are
 * UTF-8, times unknown (1980). */
static unsigned char *put_common(unsigned char *to, const entry *e, size_t name)
{
    enum { VERSION = 20, UTF8 = 1 << 11, STORED = 0, NO_TIME = 0, FIRST_DAY = 0x21 };
    to = put(to, VERSION, 2);
    to = put(to, UTF8, 2);
    to = put(to, STORED, 2);
    to = put(to, NO_TIME, 2);
    to = put(to, FIRST_DAY, 2);
    to = put(to, e->crc, 4);
    to = put(to, e->size, 4);
    to = put(to, e->size, 4);
    to = put(to, (uint32_t)name, 2);
    return put(to, 0, 2);
}

/* Reads a file once for its checksum. Its size must be the one that was announced. */
static status sum(const archive *a, const archive_file *file, uint32_t *crc)
{
    uint64_t all = 0;
    uLong value = crc32(0, NULL, 0);
    if (lseek(file->descriptor, 0, SEEK_SET) != 0) return fail_by_errno(MERLIN_BAD_INPUT, "cannot read %s", file->name);
    for (ssize_t got; (got = read(file->descriptor, a->block, BLOCK)) != 0;) {
        if (got < 0 && errno != EINTR) return fail_by_errno(MERLIN_BAD_INPUT, "cannot read %s", file->name);
        if (got < 0) continue;
        value = crc32(value, a->block, (uInt)got);
        all += (uint64_t)got;
    }
    *crc = (uint32_t)value;
    return all == file->bytes ? OK : fail(MERLIN_BAD_INPUT, "%s has changed", file->name);
}

static status copy(archive *a, const archive_file *file)
{
    status s = OK;
    uint64_t left = file->bytes;
    if (lseek(file->descriptor, 0, SEEK_SET) != 0) return fail_by_errno(MERLIN_BAD_INPUT, "cannot read %s", file->name);
    while (left && s == OK) {
        const ssize_t got = read(file->descriptor, a->block, left < BLOCK ? (size_t)left : BLOCK);
        if (got < 0 && errno == EINTR) continue;
        if (got <= 0) return fail_by_errno(MERLIN_BAD_INPUT, "cannot read %s", file->name);
        s = write_all(a, a->block, (size_t)got);
        left -= (uint64_t)got;
    }
    return s;
}

static status add(archive *a, const archive_file *file, entry *e)
{
    unsigned char head[LOCAL + MOST_NAME], *end = head;
    const size_t name = strlen(file->name);
    if (name > MOST_NAME || file->bytes > UINT32_MAX || a->at + file->bytes > UINT32_MAX - (1 << 20))
        return fail(MERLIN_CANNOT_WRITE, "the files are too large for one archive: fetch them one by one");
    e->at = (uint32_t)a->at;
    e->size = (uint32_t)file->bytes;
    status s = sum(a, file, &e->crc);
    end = put(end, 0x04034b50, 4);
    end = put_common(end, e, name);
    memcpy(end, file->name, name);
    if (s == OK) s = write_all(a, head, LOCAL + name);
    return s == OK ? copy(a, file) : s;
}

static status add_directory(archive *a, const archive_file *files, const entry *entries, size_t count)
{
    const uint32_t began = (uint32_t)a->at;
    status s = OK;
    for (size_t i = 0; i < count && s == OK; i++) {
        unsigned char head[CENTRAL + MOST_NAME] = {0}, *end = head;
        const size_t name = strlen(files[i].name);
        end = put(end, 0x02014b50, 4);
        end = put(end, 20, 2); /* the version it was made by */
        end = put_common(end, &entries[i], name);
        end = put(end, 0, 2); /* comment */
        end = put(end, 0, 4); /* disk, kind */
        end = put(end, 0, 4); /* attributes */
        end = put(end, entries[i].at, 4);
        memcpy(end, files[i].name, name);
        s = write_all(a, head, CENTRAL + name);
    }
    unsigned char tail[END], *end = tail;
    end = put(end, 0x06054b50, 4);
    end = put(end, 0, 4); /* disks */
    end = put(end, (uint32_t)count, 2);
    end = put(end, (uint32_t)count, 2);
    end = put(end, (uint32_t)a->at - began, 4);
    end = put(end, began, 4);
    put(end, 0, 2); /* comment */
    return s == OK ? write_all(a, tail, END) : s;
}

status archive_write(int out, const archive_file *files, size_t count, uint64_t *bytes)
{
    archive a = {.out = out, .block = malloc(BLOCK)};
    entry *entries = calloc(count ? count : 1, sizeof *entries);
    status s = a.block && entries ? OK : fail(MERLIN_NO_MEMORY, "no memory for an archive");
    if (s == OK && count > UINT16_MAX) s = fail(MERLIN_CANNOT_WRITE, "too many files for one archive");
    for (size_t i = 0; i < count && s == OK; i++)
        s = add(&a, &files[i], &entries[i]);
    if (s == OK) s = add_directory(&a, files, entries, count);
    *bytes = a.at;
    free(a.block);
    free(entries);
    return s;
}
