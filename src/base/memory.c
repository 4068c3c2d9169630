#include "base/memory.h"

#include <stdint.h>
#include <stdlib.h>

void *memory_new(size_t bytes)
{
    if (bytes > SIZE_MAX - 2 * MEMORY_ALIGNMENT) return NULL;
    /* calloc knows which pages are fresh; what it gave is kept just before the block */
    char *whole = calloc(1, bytes + 2 * MEMORY_ALIGNMENT);
    if (!whole) return NULL;
    size_t before = MEMORY_ALIGNMENT + (-(uintptr_t)whole & (MEMORY_ALIGNMENT - 1));
    char *block = whole + before;
    ((char **)(void *)block)[-1] = whole;
    return block;
}

void memory_free(void *block)
{
    if (block) free(((char **)block)[-1]);
}
