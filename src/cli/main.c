/* merlin: finds the subcommand and runs it. */
#include <malloc.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/file.h"
#include "base/memory.h"
#include "base/messages.h"
#include "cli/cli.h"
#include "cli/last_words.h"
#include "cli/suggest.h"
#include "image/start.h"
#include "merlin/merlin.h"

static const cli_command commands[] = {
    {"estimate", "take a photograph apart into albedo, normal, depth and roughness", cmd_estimate},
    {"relight", "show the object of a photograph under other light", cmd_relight},
    {"stereo", "surfaces from many lights, or from one photograph", cmd_stereo},
    {"render", "make training data", cmd_render},
    {"train", "train a model", cmd_train},
    {"eval", "measure a model on held-out data, beside trivial answers", cmd_eval},
    {"bench", "measure what the model and the renderer cost on this machine", cmd_bench},
    {"info", "say what is in a weights file", cmd_info},
};
enum { COMMAND_COUNT = sizeof commands / sizeof commands[0] };

static const cli_command *find_command(const char *name)
{
    for (size_t i = 0; i < COMMAND_COUNT; i++)
        if (strcmp(name, commands[i].name) == 0) return &commands[i];
    return NULL;
}

static void print_help(FILE *stream)
{
    fputs("usage: merlin COMMAND [options]\n\n"
          "One photograph of an object, taken apart into its material and lit again from elsewhere.\n\n"
          "commands:\n",
          stream);
    for (size_t i = 0; i < COMMAND_COUNT; i++)
        fprintf(stream, "  %-10s %s\n", commands[i].name, commands[i].summary);
    fputs("\nmerlin COMMAND --help explains a command; merlin --version (or -V) prints the version.\n", stream);
}

/* Says it on one line, whatever is in the name. */
static int refuse_command(const char *name)
{
    const char *names[COMMAND_COUNT + 2] = {"--help", "--version"};
    for (size_t i = 0; i < COMMAND_COUNT; i++)
        names[2 + i] = commands[i].name;
    const char *meant = suggest(name, strlen(name), names, COMMAND_COUNT + 2);
    const char *kind = name[0] == '-' ? "option" : "command";
    if (meant)
        (void)fail(ERROR_USAGE, "no %s \"%s\": did you mean %s?", kind, name, meant);
    else if (file_exists(name))
        (void)fail(ERROR_USAGE, "no command \"%s\": for a photograph, merlin estimate %s", name, name);
    else
        (void)fail(ERROR_USAGE, "no %s \"%s\"", kind, name);
    fprintf(messages(), "merlin: %s (try merlin --help)\n", status_message());
    return 2;
}

/* Output that went to a full disk or a closed pipe is a failure even if the command did not notice. */
static int finish(int code)
{
    bool written = fflush(stdout) == 0 && !ferror(stdout);
    if (!written) fprintf(messages(), "merlin: cannot write to standard output\n");
    if (!written && code == 0) code = 1;
    /* all files are closed, and what libraries would tidy up the system takes back anyway; but leaks are looked for
     * behind a proper end */
    if (MERLIN_LEAVES_AT_ONCE) _exit(code);
    return code;
}

/* Images up to some megapixels come from memory that was used before, by whatever thread: a fresh page costs more than
 * most of what is done with it. The first of that memory comes in large pages. Larger images go back to the system when
 * they are freed. */
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

/* Its matrices are too small for several threads to gain from, and the other work has them all. It asks when it is
 * loaded. */
static void one_thread_for_blas(void)
{
    setenv("OPENBLAS_NUM_THREADS", "1", 0);
}

int main(int argc, char **argv)
{
    messages_keep();
    vips_without_modules();
    one_thread_for_blas();
    if (argc < 2) {
        print_help(messages());
        return 2;
    }
    if (argc > 2 && strcmp(argv[1], "help") == 0) { /* merlin help eval photos is merlin eval photos --help */
        memmove(argv + 1, argv + 2, (size_t)(argc - 2) * sizeof *argv);
        argv[argc - 1] = "--help";
    }
    if (strcmp(argv[1], "--help") == 0 || strcmp(argv[1], "-h") == 0 || strcmp(argv[1], "help") == 0) {
        print_help(stdout);
        return finish(0);
    }
    if (strcmp(argv[1], "--version") == 0 || strcmp(argv[1], "-V") == 0) {
        printf("merlin %s\n", merlin_version());
        return finish(0);
    }
    const cli_command *command = find_command(argv[1]);
    if (!command) return refuse_command(argv[1]);
    last_words_prepare(command->name);
    reuse_memory();
    return finish(command->run(argc - 1, argv + 1));
}
