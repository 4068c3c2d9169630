/* SPDX-License-Identifier: MIT */
#include "base/file.h"

#include <ctype.h>
#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/leftovers.h"
#include "base/plain_locale.h"

bool file_exists(const char *path)
{
    struct stat s;
    return stat(path, &s) == 0;
}

bool file_is_folder(const char *path)
{
    struct stat s;
    return stat(path, &s) == 0 && S_ISDIR(s.st_mode);
}

bool file_is_same(const char *one, const char *other)
{
    struct stat a, b;
    return stat(one, &a) == 0 && stat(other, &b) == 0 && a.st_dev == b.st_dev && a.st_ino == b.st_ino;
}

/* Checks that a descriptor is a plain file of at most limit bytes, and sets *size to its length. */
static status check_size(int descriptor, const char *path, size_t limit, size_t *size)
{
    struct stat s;
    if (fstat(descriptor, &s) != 0 || !S_ISREG(s.st_mode))
        return fail(MERLIN_BAD_INPUT, "%s is not a plain file", path);
    *size = (size_t)s.st_size;
    if (*size <= limit) return OK;
    return fail(MERLIN_BAD_INPUT, "%s is %zu bytes, more than the %zu expected at most", path, *size, limit);
}

static status read_open(FILE *f, const char *path, size_t limit, char **data, size_t *size)
{
    size_t expected;
    status s = check_size(fileno(f), path, limit, &expected);
    if (s != OK) return s;
    char *buffer = malloc(expected + 1);
    if (!buffer) return fail(MERLIN_NO_MEMORY, "no memory to read %s (%zu bytes)", path, expected);
    size_t got = fread(buffer, 1, expected, f);
    if (got != expected) {
        free(buffer);
        return fail(MERLIN_BAD_INPUT, "cannot read all of %s", path);
    }
    buffer[got] = 0;
    *data = buffer;
    *size = got;
    return OK;
}

/* Opens a file for reading. Anything that is neither file nor folder is opened as a path only (O_PATH): fstat can tell
 * what it is, but a pipe is not waited for and a device is not started. O_NONBLOCK covers one that takes the file's
 * place between the two calls. */
int file_open_descriptor(const char *path)
{
    struct stat s;
    bool harmless = stat(path, &s) == 0 && (S_ISREG(s.st_mode) || S_ISDIR(s.st_mode));
    return open(path, harmless ? O_RDONLY | O_CLOEXEC | O_NONBLOCK : O_PATH | O_CLOEXEC);
}

status file_check_plain(const char *path)
{
    struct stat s;
    if (stat(path, &s) != 0) return fail_by_errno(MERLIN_BAD_INPUT, "cannot open %s", path);
    return S_ISREG(s.st_mode) ? OK : fail(MERLIN_BAD_INPUT, "%s is not a plain file", path);
}

FILE *file_open(const char *path)
{
    int descriptor = file_open_descriptor(path);
    FILE *f = descriptor < 0 ? NULL : fdopen(descriptor, "rb");
    if (!f && descriptor >= 0) close(descriptor);
    return f;
}

status file_read(const char *path, size_t limit, char **data, size_t *size)
{
    FILE *f = file_open(path);
    if (!f) return fail_by_errno(MERLIN_BAD_INPUT, "cannot open %s", path);
    status s = read_open(f, path, limit, data, size);
    fclose(f);
    return s;
}

char *file_folder_of(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? strndup(path, slash > path ? (size_t)(slash - path) : 1) : strdup(".");
}

const char *file_name_of(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

bool file_program_folder(char folder[PATH_MAX])
{
    ssize_t length = readlink("/proc/self/exe", folder, PATH_MAX - 1);
    if (length <= 0) return false;
    folder[length] = 0;
    *strrchr(folder, '/') = 0;
    return true;
}

size_t file_text_mark(const char *text, size_t size)
{
    static const char mark[] = {'\xef', '\xbb', '\xbf'};
    return size >= sizeof mark && memcmp(text, mark, sizeof mark) == 0 ? sizeof mark : 0;
}

static status map_open(int descriptor, const char *path, size_t limit, file_view *out)
{
    size_t size;
    status s = check_size(descriptor, path, limit, &size);
    if (s != OK || size == 0) return s;
    void *data = mmap(NULL, size, PROT_READ, MAP_PRIVATE | MAP_POPULATE, descriptor, 0);
    if (data == MAP_FAILED) return fail_by_errno(MERLIN_BAD_INPUT, "cannot read %s", path);
    *out = (file_view){data, size};
    return OK;
}

status file_map(const char *path, size_t limit, file_view *out)
{
    *out = (file_view){0};
    int descriptor = file_open_descriptor(path);
    if (descriptor < 0) return fail_by_errno(MERLIN_BAD_INPUT, "cannot open %s", path);
    status s = map_open(descriptor, path, limit, out);
    close(descriptor);
    return s;
}

void file_unmap(file_view *view)
{
    /* the cast is safe: mmap returned writable memory, only the reader gets it as const */
    if (view->data) munmap((void *)(uintptr_t)view->data, view->size);
    *view = (file_view){0};
}

/* Refuses to replace a device or a pipe: a rename would put a plain file in its place, so that root writing to
 * /dev/null would delete it. */
static status check_replaceable(const char *path)
{
    struct stat s;
    if (stat(path, &s) != 0 || S_ISREG(s.st_mode)) return OK;
    return fail(MERLIN_CANNOT_WRITE, "cannot write %s: it is %s", path,
                S_ISDIR(s.st_mode) ? "a folder" : "not a plain file");
}

/* Returns the end of a long name, to leave room for the prefix of a temporary name; the end is kept because its
 * extension tells the format. */
static const char *end_of_long_name(const char *name)
{
    enum { MOST = NAME_MAX - LEFTOVERS_FRONT };
    size_t length = strlen(name);
    if (length <= MOST) return name;
    name += length - MOST;
    while ((*name & 0xc0) == 0x80) /* do not begin in the middle of a UTF-8 character */
        name++;
    return name;
}

static void clear_folder_of(const char *path)
{
    char *folder = file_folder_of(path);
    if (folder) leftovers_clear_once(folder);
    free(folder);
}

/* Frees a temporary name and takes it off the list of files to remove when the program is killed. */
static void forget(char *temporary)
{
    leftovers_forget(temporary);
    free(temporary);
}

status file_temporary(const char *path, char **temporary)
{
    const char *name = file_name_of(path);
    char *out = NULL;
    status s = check_replaceable(path);
    if (s != OK) return s;
    char front[LEFTOVERS_FRONT];
    leftovers_file_front(front);
    if (asprintf(&out, "%.*s%s%s", (int)(name - path), path, front, end_of_long_name(name)) < 0)
        return fail(MERLIN_NO_MEMORY, "no memory for a file name");
    clear_folder_of(path);
    leftovers_note(out, 0);
    *temporary = out;
    return OK;
}

void file_discard(char *temporary)
{
    if (!temporary) return;
    unlink(temporary);
    forget(temporary);
}

status file_commit_all(status s, char *const *aside, const char *const *paths, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        if (!aside[i]) continue;
        if (s == OK) {
            s = file_commit(aside[i], paths[i]);
        } else {
            s = fail_shown(s, aside[i], paths[i]);
            file_discard(aside[i]);
        }
    }
    return s;
}

status file_commit(char *temporary, const char *path)
{
    status s = OK;
    if (rename(temporary, path) != 0) {
        s = fail_by_errno(MERLIN_CANNOT_WRITE, "cannot write %s", path);
        unlink(temporary);
    }
    forget(temporary);
    return s;
}

static status write_through_temporary(const char *path, const void *data, size_t size, bool durable)
{
    char *temporary = NULL;
    status s = file_temporary(path, &temporary);
    if (s != OK) return s;
    FILE *f = fopen(temporary, "wb");
    if (!f) {
        s = fail_by_errno(MERLIN_CANNOT_WRITE, "cannot write %s", path);
        forget(temporary);
        return s;
    }
    bool written = fwrite(data, 1, size, f) == size;
    if (written && durable) written = fflush(f) == 0 && fsync(fileno(f)) == 0;
    bool closed = fclose(f) == 0;
    if (!written || !closed) {
        s = fail_by_errno(MERLIN_CANNOT_WRITE, "cannot write %s", path);
        file_discard(temporary);
        return s;
    }
    return file_commit(temporary, path);
}

status file_check_writable(const char *path)
{
    char *temporary;
    status s = file_temporary(path, &temporary);
    if (s != OK) return s;
    FILE *f = fopen(temporary, "wb");
    if (!f) s = fail_by_errno(MERLIN_CANNOT_WRITE, "cannot write %s", path);
    if (f) fclose(f);
    file_discard(temporary);
    return s;
}

status file_write(const char *path, const void *data, size_t size)
{
    return write_through_temporary(path, data, size, false);
}

status file_write_durable(const char *path, const void *data, size_t size)
{
    return write_through_temporary(path, data, size, true);
}

status file_print(const char *path, file_printer *print, const void *context)
{
    char *temporary;
    status s = file_temporary(path, &temporary);
    if (s != OK) return s;
    FILE *f = fopen(temporary, "wb");
    if (!f) {
        s = fail_by_errno(MERLIN_CANNOT_WRITE, "cannot write %s", path);
        forget(temporary);
        return s;
    }
    locale_t before = uselocale(plain_locale());
    print(f, context);
    uselocale(before);
    bool written = !ferror(f);
    written &= fclose(f) == 0;
    if (written) return file_commit(temporary, path);
    file_discard(temporary);
    return fail(MERLIN_CANNOT_WRITE, "cannot write %s: is the disk full?", path);
}

static status make_one(const char *path)
{
    if (mkdir(path, 0777) == 0) return OK;
    const int why = errno;
    if (file_is_folder(path)) return OK;
    if (why == EEXIST)
        return fail(MERLIN_CANNOT_WRITE, "cannot make the folder %s: a file of that name is in the way", path);
    errno = why;
    return fail_by_errno(MERLIN_CANNOT_WRITE, "cannot make the folder %s", path);
}

status file_make_folder(const char *path)
{
    if (!*path) return fail(MERLIN_CANNOT_WRITE, "cannot make a folder that has no name");
    char *copy = strdup(path);
    if (!copy) return fail(MERLIN_NO_MEMORY, "no memory for a file name");
    status s = OK;
    for (char *p = copy + 1; s == OK; p++) {
        if (*p != '/' && *p != 0) continue;
        char end = *p;
        *p = 0;
        s = make_one(copy);
        *p = end;
        if (end == 0) break;
    }
    free(copy);
    return s;
}

char *file_join(const char *folder, const char *name)
{
    char *out = NULL;
    size_t n = strlen(folder);
    const char *between = n > 0 && folder[n - 1] == '/' ? "" : "/";
    return asprintf(&out, "%s%s%s", folder, between, name) < 0 ? NULL : out;
}

char *file_in_scratch(const char *name)
{
    const char *folder = getenv("TMPDIR");
    return file_join(folder && *folder ? folder : "/tmp", name);
}

bool file_is_in(const char *folder, const char *name)
{
    char path[PATH_MAX];
    const int length = snprintf(path, sizeof path, "%s/%s", folder, name); /* no memory, so that it cannot lack */
    return length > 0 && (size_t)length < sizeof path && file_exists(path);
}

bool file_ends_in(const char *name, const char *ending)
{
    size_t n = strlen(name), m = strlen(ending);
    return n > m && strcasecmp(name + n - m, ending) == 0;
}

bool file_ends_in_any(const char *name, const char *const *endings)
{
    for (; *endings; endings++)
        if (file_ends_in(name, *endings)) return true;
    return false;
}

/* Compares the numbers that begin at *a and *b, and moves both pointers behind them. */
static int compare_numbers(const char **a, const char **b)
{
    const char *x = *a + strspn(*a, "0"), *y = *b + strspn(*b, "0");
    size_t n = strspn(x, "0123456789"), m = strspn(y, "0123456789");
    *a = x + n;
    *b = y + m;
    return n != m ? (n > m) - (n < m) : memcmp(x, y, n);
}

int file_compare_names(const char *a, const char *b)
{
    const char *x = a, *y = b;
    while (*x && *y) {
        bool number = isdigit((unsigned char)*x) && isdigit((unsigned char)*y);
        int order = number ? compare_numbers(&x, &y) : (unsigned char)*x++ - (unsigned char)*y++;
        if (order) return order;
    }
    int order = (unsigned char)*x - (unsigned char)*y;
    return order ? order : strcmp(a, b);
}

static int compare_names(const void *a, const void *b)
{
    return file_compare_names(*(char *const *)a, *(char *const *)b);
}

static bool append(char ***names, size_t *count, size_t *room, char *path)
{
    if (*count == *room) {
        size_t grown = *room ? 2 * *room : 64;
        char **larger = realloc(*names, grown * sizeof *larger);
        if (!larger) return false;
        *names = larger;
        *room = grown;
    }
    (*names)[(*count)++] = path;
    return true;
}

/* Appends a folder's files to the list, and with `deep` those of its sub-folders. */
static status list_into(const char *folder, const char *const *endings, bool deep, char ***names, size_t *count,
                        size_t *room)
{
    DIR *d = opendir(folder);
    if (!d) return fail_by_errno(MERLIN_BAD_INPUT, "cannot open the folder %s", folder);
    status s = OK;
    for (struct dirent *e; s == OK && (errno = 0, e = readdir(d));) {
        if (e->d_name[0] == '.') continue; /* hidden files, temporary files among them */
        char *path = file_join(folder, e->d_name);
        bool below = path && file_is_folder(path);
        if (below && deep) s = list_into(path, endings, false, names, count, room);
        if (path && (below || (endings && !file_ends_in_any(e->d_name, endings)))) {
            free(path);
            continue;
        }
        if (!path || !append(names, count, room, path)) {
            free(path);
            s = fail(MERLIN_NO_MEMORY, "no memory for the names in %s", folder);
        }
    }
    if (s == OK && errno) s = fail_by_errno(MERLIN_BAD_INPUT, "cannot read the folder %s", folder);
    closedir(d);
    return s;
}

static status list(const char *folder, const char *const *endings, bool deep, char ***names, size_t *count)
{
    *names = NULL;
    *count = 0;
    size_t room = 0;
    status s = list_into(folder, endings, deep, names, count, &room);
    if (s != OK) {
        file_list_free(*names, *count);
        *names = NULL;
        *count = 0;
    } else if (*count > 1) {
        qsort(*names, *count, sizeof **names, compare_names);
    }
    return s;
}

status file_list(const char *folder, const char *const *endings, char ***names, size_t *count)
{
    return list(folder, endings, false, names, count);
}

status file_list_deep(const char *folder, const char *const *endings, char ***names, size_t *count)
{
    return list(folder, endings, true, names, count);
}

void file_list_free(char **names, size_t count)
{
    for (size_t i = 0; i < count; i++)
        free(names[i]);
    free(names);
}

status file_find_named(const char *folder, const char *const *usual, char **path)
{
    char **names;
    size_t count;
    *path = NULL;
    status s = file_list(folder, NULL, &names, &count);
    if (s != OK) return s;
    const char *found = NULL;
    for (size_t k = 0; usual[k] && !found; k++)
        for (size_t i = 0; i < count; i++) {
            bool exact = strcmp(file_name_of(names[i]), usual[k]) == 0;
            if (exact || (!found && strcasecmp(file_name_of(names[i]), usual[k]) == 0)) found = names[i];
        }
    if (found && !(*path = strdup(found))) s = fail(MERLIN_NO_MEMORY, "no memory for a file name");
    file_list_free(names, count);
    return s;
}
