/* SPDX-License-Identifier: MIT */
#include "base/progress.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <time.h>
#include <unistd.h>

#include "base/messages.h"

double clock_seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

void progress_time(double seconds, char out[PROGRESS_TIME])
{
    long s = (long)(seconds + 0.5);
    if (s >= 3600)
        snprintf(out, PROGRESS_TIME, "%ld:%02ld:%02ld", s / 3600, s / 60 % 60, s % 60);
    else
        snprintf(out, PROGRESS_TIME, "%ld:%02ld", s / 60, s % 60);
}

/* ---- one line of a terminal ---- */

bool progress_is_seen(void)
{
    const char *kind = getenv("TERM");
    return isatty(fileno(messages())) != 0 && !(kind && strcmp(kind, "dumb") == 0);
}

static size_t columns(void)
{
    enum { USUAL = 80 };
    struct winsize size;
    bool told = ioctl(fileno(messages()), TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
    return told ? size.ws_col : USUAL;
}

void progress_draw(const char *label, double share, const char *words)
{
    enum { WIDTH = 28 };
    char bar[WIDTH + 1], line[256];
    for (int i = 0; i < WIDTH; i++)
        bar[i] = (double)i + 1 <= share * WIDTH ? '#' : '.';
    bar[WIDTH] = 0;
    snprintf(line, sizeof line, "%s [%s] %s", label, bar, words);
    size_t room = columns() - 1; /* not the last column, where some terminals wrap */
    if (room < sizeof line) line[room] = 0;
    fprintf(messages(), "\r%s\033[K", line);
    fflush(messages());
}

void progress_clear(void)
{
    fputs("\r\033[K", messages());
    fflush(messages());
}

/* ---- counted work ---- */

static double share_of(const progress *p)
{
    return p->total ? (double)p->done / (double)p->total : 1;
}

void progress_begin(progress *p, const char *label, const char *unit, size_t done, size_t total, bool quiet)
{
    *p = (progress){.label = label,
                    .unit = unit,
                    .done = done,
                    .first = done,
                    .total = total,
                    .started = clock_seconds(),
                    .quiet = quiet,
                    .terminal = progress_is_seen()};
    p->shown = p->started;
    pace_begin(&p->pace, share_of(p), p->started);
}

static void show(const progress *p, double now, const char *note)
{
    double elapsed = now - p->started, seconds = pace_left(&p->pace, now);
    double rate = elapsed > 0 ? (double)(p->done - p->first) / elapsed : 0;
    char left[PROGRESS_TIME] = "?", words[160];
    if (seconds >= 0) progress_time(seconds, left);
    const char *extra = note ? note : "";
    if (p->terminal) {
        snprintf(words, sizeof words, "%zu/%zu  %.3g %s/s  %s left  %s", p->done, p->total, rate, p->unit, left, extra);
        progress_draw(p->label, share_of(p), words);
        return;
    }
    fprintf(messages(), "%s %zu/%zu, %.3g %s/s, %s left %s\n", p->label, p->done, p->total, rate, p->unit, left, extra);
    fflush(messages());
}

void progress_update(progress *p, size_t done, const char *note)
{
    p->done = done;
    if (p->quiet) return;
    double now = clock_seconds();
    pace_note(&p->pace, share_of(p), now);
    if (now - p->shown < (p->terminal ? 0.2 : 10.0)) return;
    p->shown = now;
    show(p, now, note);
}

void progress_end(progress *p)
{
    if (p->quiet) return;
    show(p, clock_seconds(), NULL);
    if (p->terminal) fputc('\n', messages());
}
