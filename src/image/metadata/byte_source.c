/* SPDX-License-Identifier: MIT */
#include "image/metadata/byte_source.h"

#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/file.h"

bool byte_source_open(byte_source *s, const char *path)
{
    byte_source_of_file(s, file_open_descriptor(path));
    return s->file >= 0;
}

void byte_source_close(byte_source *s)
{
    if (s->file >= 0) close(s->file);
    s->file = -1;
}

static void begin(byte_source *s, int file, const uint8_t *memory, uint64_t at, uint64_t size)
{
    s->file = file;
    s->memory = memory;
    s->begin = at;
    s->size = size;
    s->block_at = 0;
    s->block_size = 0;
}

void byte_source_of_file(byte_source *s, int file)
{
    struct stat about;
    const bool plain = file >= 0 && fstat(file, &about) == 0 && S_ISREG(about.st_mode);
    begin(s, file, NULL, 0, plain ? (uint64_t)about.st_size : 0);
}

void byte_source_of_memory(byte_source *s, const void *bytes, size_t size)
{
    begin(s, -1, bytes, 0, size);
}

void byte_source_of_part(byte_source *s, const byte_source *whole, uint64_t at, uint64_t size)
{
    const uint64_t rest = at < whole->size ? whole->size - at : 0;
    begin(s, whole->file, whole->memory, whole->begin + (rest ? at : 0), size < rest ? size : rest);
}

/* Bytes of the file from a place of it on, from the block or, where they are not in it, by way of it. */
static size_t read_file(byte_source *s, uint64_t at, uint8_t *to, size_t count)
{
    if (at < s->block_at || at >= s->block_at + s->block_size) {
        s->block_at = at - at % BYTE_SOURCE_BLOCK;
        const ssize_t got = pread(s->file, s->block, BYTE_SOURCE_BLOCK, (off_t)s->block_at);
        s->block_size = got > 0 ? (size_t)got : 0;
        if (at >= s->block_at + s->block_size) return 0;
    }
    const size_t from = (size_t)(at - s->block_at), held = s->block_size - from;
    const size_t taken = count < held ? count : held;
    memcpy(to, s->block + from, taken);
    return taken;
}

size_t byte_source_read(byte_source *s, uint64_t at, void *to, size_t count)
{
    if (at >= s->size) return 0;
    if (count > s->size - at) count = (size_t)(s->size - at);
    if (s->memory) {
        memcpy(to, s->memory + s->begin + at, count);
        return count;
    }
    size_t done = 0;
    for (size_t got; done < count; done += got)
        if (!(got = read_file(s, s->begin + at + done, (uint8_t *)to + done, count - done))) break;
    return done;
}
