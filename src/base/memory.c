/* SPDX-License-Identifier: MIT */
#include "base/memory.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

/* size of a large page, and of the smallest block that is likely to hold two whole ones */
static const size_t LARGE_PAGE = (size_t)2 << 20, LEAST_BLOCK = (size_t)6 << 20;

/* The header in front of a block. */
typedef struct origin {
    void *whole;   /* what the system returned */
    size_t mapped; /* bytes mapped; 0: allocated by calloc */
} origin;

static origin *origin_of(void *block)
{
    return (origin *)block - 1;
}

/* Allocates zeros. Large blocks are mapped: calloc would clear memory it has reused, though the caller may never read
 * it. */
static origin take(size_t bytes)
{
    if (bytes < LEAST_BLOCK) return (origin){calloc(1, bytes), 0};
    void *whole = mmap(NULL, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    return (origin){whole == MAP_FAILED ? NULL : whole, bytes};
}

void *memory_new(size_t bytes)
{
    if (bytes > SIZE_MAX - 2 * MEMORY_ALIGNMENT) return NULL;
    origin from = take(bytes + 2 * MEMORY_ALIGNMENT);
    if (!from.whole) return NULL;
    size_t before = MEMORY_ALIGNMENT + (-(uintptr_t)from.whole & (MEMORY_ALIGNMENT - 1));
    char *block = (char *)from.whole + before;
    *origin_of(block) = from;
    memory_prefer_large_pages(block, bytes);
    return block;
}

void memory_free(void *block)
{
    if (!block) return;
    origin from = *origin_of(block);
    if (from.mapped)
        munmap(from.whole, from.mapped);
    else
        free(from.whole);
}

/* Closing alone does not tell: what was printed may have been refused before, or what is there be gone then. */
bool memory_stream_close(FILE *stream, char **text)
{
    const bool printed = !ferror(stream), closed = fclose(stream) == 0;
    if (printed && closed && *text) return true;
    free(*text);
    *text = NULL;
    return false;
}

bool memory_is_left(size_t bytes)
{
    void *whole = mmap(NULL, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    return whole != MAP_FAILED && munmap(whole, bytes) == 0;
}

void memory_prefer_large_pages(void *block, size_t bytes)
{
    if (!block || bytes < LEAST_BLOCK) return;
    char *first = (char *)block + (-(uintptr_t)block & (LARGE_PAGE - 1));
    size_t whole = (size_t)((char *)block + bytes - first) & ~(LARGE_PAGE - 1);
    (void)madvise(first, whole, MADV_HUGEPAGE); /* only advice, so that failure does not matter */
}

void memory_forget(void *part, size_t bytes)
{
    const size_t page = (size_t)sysconf(_SC_PAGESIZE);
    char *end = (char *)part + bytes, *first = (char *)part + (-(uintptr_t)part & (page - 1));
    char *last = end - ((uintptr_t)end & (page - 1));
    if (first >= last || madvise(first, (size_t)(last - first), MADV_DONTNEED) != 0) {
        memset(part, 0, bytes);
        return;
    }
    memset(part, 0, (size_t)(first - (char *)part));
    memset(last, 0, (size_t)(end - last));
}
