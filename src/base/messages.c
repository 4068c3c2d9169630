/* SPDX-License-Identifier: MIT */
#include "base/messages.h"

#include <fcntl.h>
#include <pthread.h>
#include <stdbool.h>
#include <stdlib.h>
#include <unistd.h>

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
enum { SANITIZED = 1 };
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(memory_sanitizer) || __has_feature(thread_sanitizer)
enum { SANITIZED = 1 };
#else
enum { SANITIZED = 0 };
#endif
#else
enum { SANITIZED = 0 };
#endif

enum { BEYOND_STANDARD = 3 };

static FILE *own;
static const char *program = "merlin";
static int nowhere = -1;
static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
static int inside; /* number of threads in decoders */

void messages_keep(void)
{
    if (SANITIZED || own || getenv("MERLIN_LIBRARY_MESSAGES")) return;
    int copy = fcntl(STDERR_FILENO, F_DUPFD_CLOEXEC, BEYOND_STANDARD);
    int opened = copy < 0 ? -1 : open("/dev/null", O_WRONLY | O_CLOEXEC);
    FILE *stream = opened < 0 ? NULL : fdopen(copy, "w");
    if (!stream) {
        if (opened >= 0) close(opened);
        if (copy >= 0) close(copy);
        return;
    }
    setvbuf(stream, NULL, _IONBF, 0); /* unbuffered, as standard error is */
    own = stream;
    nowhere = opened;
}

FILE *messages(void)
{
    return own ? own : stderr;
}

void messages_set_program(const char *name)
{
    program = name;
}

const char *messages_program(void)
{
    return program;
}

void messages_one_line(char *text)
{
    for (char *c = text; *c; c++)
        if ((unsigned char)*c < ' ') *c = '?';
}

void messages_mute(void)
{
    if (!own) return;
    pthread_mutex_lock(&lock);
    if (inside++ == 0) (void)dup2(nowhere, STDERR_FILENO);
    pthread_mutex_unlock(&lock);
}

void messages_unmute(void)
{
    if (!own) return;
    pthread_mutex_lock(&lock);
    if (--inside == 0) (void)dup2(fileno(own), STDERR_FILENO);
    pthread_mutex_unlock(&lock);
}
