#include "base/progress.h"

#include <stdio.h>
#include <time.h>
#include <unistd.h>

#include "base/messages.h"

double clock_seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
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
                    .terminal = isatty(fileno(messages())) != 0};
    p->shown = p->started;
}

static void format_time(char *out, size_t size, double seconds)
{
    long s = (long)(seconds + 0.5);
    if (s >= 3600)
        snprintf(out, size, "%ld:%02ld:%02ld", s / 3600, s / 60 % 60, s % 60);
    else
        snprintf(out, size, "%ld:%02ld", s / 60, s % 60);
}

static void show(progress *p, const char *note)
{
    double elapsed = clock_seconds() - p->started;
    double rate = elapsed > 0 ? (double)(p->done - p->first) / elapsed : 0;
    char left[32] = "?";
    if (rate > 0) format_time(left, sizeof left, (double)(p->total - p->done) / rate);
    const char *extra = note ? note : "";
    if (p->terminal) {
        enum { WIDTH = 28 };
        char bar[WIDTH + 1];
        size_t filled = p->total ? p->done * WIDTH / p->total : WIDTH;
        for (size_t i = 0; i < WIDTH; i++)
            bar[i] = i < filled ? '#' : '.';
        bar[WIDTH] = 0;
        fprintf(messages(), "\r%s [%s] %zu/%zu  %.3g %s/s  %s left  %s\033[K", p->label, bar, p->done, p->total, rate,
                p->unit, left, extra);
    } else {
        fprintf(messages(), "%s %zu/%zu, %.3g %s/s, %s left %s\n", p->label, p->done, p->total, rate, p->unit, left,
                extra);
    }
    fflush(messages());
}

void progress_update(progress *p, size_t done, const char *note)
{
    p->done = done;
    if (p->quiet) return;
    double now = clock_seconds();
    if (now - p->shown < (p->terminal ? 0.2 : 10.0)) return;
    p->shown = now;
    show(p, note);
}

void progress_end(progress *p)
{
    if (p->quiet) return;
    show(p, NULL);
    if (p->terminal) fputc('\n', messages());
}
