/* SPDX-License-Identifier: MIT */
#include "command/program.h"

#include <malloc.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/file.h"
#include "base/memory.h"
#include "base/messages.h"
#include "command/last_words.h"
#include "command/suggest.h"
#include "merlin/merlin.h"

static const cli_command *find_command(const program *p, const char *name)
{
    for (size_t i = 0; i < p->count; i++)
        if (strcmp(name, p->commands[i].name) == 0) return &p->commands[i];
    return NULL;
}

static void print_help(const program *p, FILE *stream)
{
    fprintf(stream, "usage: %s COMMAND [options]\n\n%s\n\ncommands:\n", p->name, p->about);
    for (size_t i = 0; i < p->count; i++)
        fprintf(stream, "  %-10s %s\n", p->commands[i].name, p->commands[i].summary);
    fprintf(stream, "\n%s COMMAND --help explains a command; %s --version (or -V) prints the version.\n", p->name,
            p->name);
}

static bool is_elsewhere(const program *p, const char *name)
{
    for (const char *const *at = p->elsewhere; at && *at; at++)
        if (strcmp(name, *at) == 0) return true;
    return false;
}

/* Returns the most similar command; NULL if none is similar. */
static const char *suggested(const program *p, const char *name)
{
    enum { MOST = 16 };
    const char *names[MOST + 2] = {"--help", "--version"};
    size_t count = 2;
    for (size_t i = 0; i < p->count && count < MOST + 2; i++)
        names[count++] = p->commands[i].name;
    return suggest(name, strlen(name), names, count);
}

/* Reports an unknown command on one line, whatever is in its name. */
static int refuse_command(const program *p, const char *name)
{
    const char *meant = suggested(p, name), *kind = name[0] == '-' ? "option" : "command";
    if (is_elsewhere(p, name))
        (void)fail(MERLIN_WRONG_USE, "%s is a command of another program: %s %s", name, p->other, name);
    else if (meant)
        (void)fail(MERLIN_WRONG_USE, "no %s \"%s\": did you mean %s?", kind, name, meant);
    else if (file_exists(name))
        (void)fail(MERLIN_WRONG_USE, "no command \"%s\": for a photograph, merlin estimate %s", name, name);
    else
        (void)fail(MERLIN_WRONG_USE, "no %s \"%s\"", kind, name);
    fprintf(messages(), "%s: %s (try %s --help)\n", p->name, status_message(), p->name);
    return 2;
}

/* Returns failure if output went to a full disk or a closed pipe, even if the command did not notice. */
static int finish(int code)
{
    bool written = fflush(stdout) == 0 && !ferror(stdout);
    if (!written && code == 0) {
        fprintf(messages(), "%s: cannot write to standard output\n", messages_program());
        code = 1;
    }
    /* all files are closed, and the system frees what libraries would; but leak checkers need a normal exit */
    if (MERLIN_LEAVES_AT_ONCE) _exit(code);
    return code;
}

/* Reuses memory for images of up to some megapixels, in all threads, as new pages cost more than most operations on
 * them. The first of that memory consists of large pages. Larger images are returned to the system when they are freed.
 */
static void reuse_memory(void)
{
    enum { FIRST = 64 << 20 };
    mallopt(M_ARENA_MAX, 1);
    mallopt(M_TOP_PAD, 4 << 20);
    mallopt(M_TRIM_THRESHOLD, 2 * FIRST);
    mallopt(M_MMAP_THRESHOLD, 2 * FIRST);
    void *first = malloc(FIRST);
    memory_prefer_large_pages(first, FIRST);
    free(first);
    mallopt(M_MMAP_THRESHOLD, 8 << 20);
}

/* Limits OpenBLAS to one thread, before it is loaded and reads the variable: its matrices are too small for several,
 * and other work uses them all. */
static void one_thread_for_blas(void)
{
    setenv("OPENBLAS_NUM_THREADS", "1", 0);
}

/* Makes libvips start without its modules, which takes longer than everything else it does for a small picture. Only
 * HEIF's is needed here, and the library loads it by itself. */
static void leave_modules_out(void)
{
    setenv("VIPSHOME", "/nonexistent", 0); /* where it looks for modules; a value set by the user is kept */
}

int program_run(const program *p, int argc, char **argv)
{
    messages_keep();
    messages_set_program(p->name);
    leave_modules_out();
    one_thread_for_blas();
    if (argc < 2) {
        print_help(p, messages());
        return 2;
    }
    if (argc > 2 && strcmp(argv[1], "help") == 0) { /* merlin-lab help eval photos is merlin-lab eval photos --help */
        memmove(argv + 1, argv + 2, (size_t)(argc - 2) * sizeof *argv);
        argv[argc - 1] = "--help";
    }
    if (strcmp(argv[1], "--help") == 0 || strcmp(argv[1], "-h") == 0 || strcmp(argv[1], "help") == 0) {
        print_help(p, stdout);
        return finish(0);
    }
    if (strcmp(argv[1], "--version") == 0 || strcmp(argv[1], "-V") == 0) {
        printf("%s %s\n", p->name, merlin_version());
        return finish(0);
    }
    const cli_command *command = find_command(p, argv[1]);
    if (!command) return refuse_command(p, argv[1]);
    last_words_prepare(command->name);
    reuse_memory();
    return finish(command->run(argc - 1, argv + 1));
}
