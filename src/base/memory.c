#include "base/memory.h"

#include <stdint.h>
#include <stdlib.h>
#include <sys/mman.h>

/* A large page, and the least block that is likely to hold two whole ones. */
static const size_t LARGE_PAGE = (size_t)2 << 20, LEAST_BLOCK = (size_t)6 << 20;

void *memory_new(size_t bytes)
{
    if (bytes > SIZE_MAX - 2 * MEMORY_ALIGNMENT) return NULL;
    /* calloc knows which pages are fresh; what it gave is kept just before the block */
    char *whole = calloc(1, bytes + 2 * MEMORY_ALIGNMENT);
    if (!whole) return NULL;
    size_t before = MEMORY_ALIGNMENT + (-(uintptr_t)whole & (MEMORY_ALIGNMENT - 1));
    char *block = whole + before;
    memory_prefer_large_pages(block, bytes);
    ((char **)(void *)block)[-1] = whole;
    return block;
}

void memory_free(void *block)
{
    if (block) free(((char **)block)[-1]);
}

void memory_prefer_large_pages(void *block, size_t bytes)
{
    if (!block || bytes < LEAST_BLOCK) return;
    char *first = (char *)block + (-(uintptr_t)block & (LARGE_PAGE - 1));
    size_t whole = (size_t)((char *)block + bytes - first) & ~(LARGE_PAGE - 1);
    (void)madvise(first, whole, MADV_HUGEPAGE); /* it is only advice */
}
