/* SPDX-License-Identifier: MIT */
#include "command/last_words.h"

#include <signal.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "base/fragile.h"
#include "base/leftovers.h"
#include "base/memory.h"
#include "base/messages.h"

/* Size of a stack of OpenMP's or GLib's threads, their largest own allocation, with a margin. */
static const size_t little = (size_t)32 << 20;

static int descriptor;
static char line[128];

/* Tells whether a signal means lack of memory: GLib, C++ and OpenMP end by an abort or a trap; a crash counts only
 * while they are called. */
static bool is_lack(int number)
{
    if (number == SIGSEGV || number == SIGBUS) return fragile_is_here();
    return fragile_is_anywhere() || !memory_is_left(little);
}

/* Ends the program without functions that take a lock or allocate, as the thread may hold any lock. */
static void end_by(int number)
{
    signal(number, SIG_DFL);
    if (!is_lack(number)) {
        raise(number);
        return;
    }
    leftovers_remove_own();
    if (write(descriptor, line, strlen(line)) < 0) { /* nobody can read it */
    }
    _exit(1);
}

void last_words_prepare(const char *command)
{
    static const int ends[] = {SIGABRT, SIGTRAP, SIGSEGV, SIGBUS};
    struct sigaction action = {.sa_handler = end_by};
    if (!MERLIN_LEAVES_AT_ONCE) return;
    descriptor = fileno(messages());
    snprintf(line, sizeof line, "%.32s %.32s: out of memory, or of threads: the system gives no more\n",
             messages_program(), command);
    sigemptyset(&action.sa_mask);
    for (size_t i = 0; i < sizeof ends / sizeof *ends; i++)
        sigaction(ends[i], &action, NULL);
}
