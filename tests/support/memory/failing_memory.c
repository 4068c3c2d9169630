/* SPDX-License-Identifier: MIT */
#include "failing_memory.h"

#include <dlfcn.h>
#include <errno.h>
#include <execinfo.h>
#include <link.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>

/* ---- whose calls count ---- */

typedef struct range {
    uintptr_t first, end;
} range;

enum { MOST_RANGES = 16 };
static range counted[MOST_RANGES]; /* the program's own stands first */
static int counted_count;
static bool own_alone;

static bool is_counted(const char *library)
{
    static const char *const names[] = {
        "/libc.so",         "/libcjson.so",    "/libpng16.so", "/libjpeg.so",    "/libdeflate.so",
        "/libOpenEXRCore-", "/libfreetype.so", "/libz.so",     "/libcholmod.so", "/libsuitesparseconfig.so"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (strstr(library, names[i])) return true;
    return false;
}

/* The program comes first, without a name. */
static int add_range(struct dl_phdr_info *object, size_t size, void *context)
{
    (void)size;
    (void)context;
    if (counted_count && (own_alone || !is_counted(object->dlpi_name))) return 0;
    for (int i = 0; i < object->dlpi_phnum; i++) {
        const ElfW(Phdr) *part = &object->dlpi_phdr[i];
        if (part->p_type != PT_LOAD || !(part->p_flags & PF_X) || counted_count == MOST_RANGES) continue;
        uintptr_t first = object->dlpi_addr + part->p_vaddr;
        counted[counted_count++] = (range){first, first + part->p_memsz};
    }
    return 0;
}

void failing_memory_of_libraries(bool theirs_too)
{
    own_alone = !theirs_too;
}

static bool is_in(const void *caller, range r)
{
    return (uintptr_t)caller >= r.first && (uintptr_t)caller < r.end;
}

static bool counts(const void *caller)
{
    for (int i = 0; i < counted_count; i++)
        if (is_in(caller, counted[i])) return true;
    return false;
}

/* ---- ways through the program ---- */

/* Frames that are looked through. The innermost ones of the program and of the libraries that count make the way, so
 * many of each; the first ones are this file's own. */
enum { DEEP = 20, OWN = 3, OF_PROGRAM = 3, OF_LIBRARIES = 2, MOST_WAYS = 1 << 18 };
typedef struct way {
    const void *at[OF_LIBRARIES + OF_PROGRAM];
} way;
static way *ways;

static __attribute__((noinline)) void keep_way(size_t n)
{
    if (n >= MOST_WAYS) return;
    void *frames[DEEP];
    int all = backtrace(frames, DEEP), of_program = 0, of_libraries = 0;
    for (int i = OWN; i < all && of_program < OF_PROGRAM; i++) {
        const bool own = is_in(frames[i], counted[0]);
        if (own)
            ways[n].at[OF_LIBRARIES + of_program++] = frames[i];
        else if (of_libraries < OF_LIBRARIES && counts(frames[i]))
            ways[n].at[of_libraries++] = frames[i];
    }
}

/* FNV-1a */
uint64_t failing_memory_way(size_t n)
{
    uint64_t sum = 0xcbf29ce484222325;
    if (n >= MOST_WAYS) return n;
    for (int i = 0; i < OF_LIBRARIES + OF_PROGRAM; i++)
        sum = (sum ^ (uintptr_t)ways[n].at[i]) * 0x100000001b3;
    return sum;
}

void failing_memory_print_way(size_t n)
{
    for (int i = 0; n < MOST_WAYS && i < OF_LIBRARIES + OF_PROGRAM; i++) {
        Dl_info about;
        if (!ways[n].at[i] || !dladdr(ways[n].at[i], &about)) continue;
        fprintf(stderr, " %s+%#zx", strrchr(about.dli_fname, '/') ? strrchr(about.dli_fname, '/') + 1 : about.dli_fname,
                (size_t)((const char *)ways[n].at[i] - (const char *)about.dli_fbase - 1));
    }
    fputc('\n', stderr);
}

/* ---- what fails ---- */

static enum { PASSING, COUNTING, FAILING } mode;
static atomic_size_t calls;
static size_t fails_at;
static bool fails_behind;
static _Thread_local bool inside; /* of what is called below */

static __attribute__((noinline)) bool fails(const void *caller)
{
    if (mode == PASSING || inside || !counts(caller)) return false;
    size_t n = atomic_fetch_add(&calls, 1) + 1;
    if (mode == COUNTING) {
        inside = true;
        keep_way(n);
        inside = false;
        return false;
    }
    if (n != fails_at && !(fails_behind && n > fails_at)) return false;
    errno = ENOMEM;
    return true;
}

static void begin(void)
{
    counted_count = 0;
    dl_iterate_phdr(add_range, NULL);
    atomic_store(&calls, 0);
}

void failing_memory_count(void)
{
    begin();
    if (!ways) ways = malloc(MOST_WAYS * sizeof *ways);
    if (!ways) abort();
    memset(ways, 0, MOST_WAYS * sizeof *ways);
    void *once[1];
    backtrace(once, 1); /* loads what it needs */
    mode = COUNTING;
}

void failing_memory_begin(size_t n, bool and_all_behind)
{
    begin();
    fails_at = n;
    fails_behind = and_all_behind;
    mode = FAILING;
}

size_t failing_memory_end(void)
{
    mode = PASSING;
    return atomic_load(&calls);
}

/* ---- in front of the system's ---- */

/* By name, since the sanitizer's stand between these and the C library's. */
#define NEXT(name)                                                                                                     \
    static __typeof__(&name) next;                                                                                     \
    if (!next) *(void **)&next = dlsym(RTLD_NEXT, #name)

void *malloc(size_t size)
{
    NEXT(malloc);
    return fails(__builtin_return_address(0)) ? NULL : next(size);
}

void *calloc(size_t count, size_t size)
{
    NEXT(calloc);
    return fails(__builtin_return_address(0)) ? NULL : next(count, size);
}

void *realloc(void *block, size_t size)
{
    NEXT(realloc);
    return fails(__builtin_return_address(0)) ? NULL : next(block, size);
}

void *mmap(void *at, size_t size, int protection, int flags, int file, off_t offset)
{
    NEXT(mmap);
    return fails(__builtin_return_address(0)) ? MAP_FAILED : next(at, size, protection, flags, file, offset);
}

/* The sanitizer asks for it at the start of every thread, and ends the program without an answer. A thread of a library
 * that has just been loaded may start when another run has begun. */
int pthread_getattr_np(pthread_t thread, pthread_attr_t *of)
{
    NEXT(pthread_getattr_np);
    inside = true;
    const int result = next(thread, of);
    inside = false;
    return result;
}

/* The sanitizer's would not call malloc. */
char *strndup(const char *text, size_t most)
{
    size_t length = strnlen(text, most);
    NEXT(malloc);
    char *copy = fails(__builtin_return_address(0)) ? NULL : next(length + 1);
    if (!copy) return NULL;
    copy[length] = 0;
    return memcpy(copy, text, length);
}

char *strdup(const char *text)
{
    size_t length = strlen(text);
    NEXT(malloc);
    char *copy = fails(__builtin_return_address(0)) ? NULL : next(length + 1);
    return copy ? memcpy(copy, text, length + 1) : NULL;
}
