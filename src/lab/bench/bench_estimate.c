/* SPDX-License-Identifier: MIT */
#include "lab/bench/bench_estimate.h"

#include <cjson/cJSON.h>
#include <errno.h>
#include <fcntl.h>
#include <ftw.h>
#ifdef __GLIBC__
#include <malloc.h>
#endif
#include <spawn.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/file.h"
#include "base/progress.h"
#include "image/write/write.h"
#include "lab/bench/bench_ball.h"

extern char **environ;

enum { MAX_RUNS = 32 };

void bench_reset_resident(void)
{
#ifdef __GLIBC__
    malloc_trim(0); /* return freed memory, so that it does not count in what is measured next */
#endif
    FILE *f = fopen("/proc/self/clear_refs", "w");
    if (!f) return;
    fputs("5", f);
    fclose(f);
}

size_t bench_peak_resident(void)
{
    FILE *f = fopen("/proc/self/status", "r");
    if (!f) return 0;
    char line[256];
    size_t kilobytes = 0;
    while (fgets(line, sizeof line, f))
        if (sscanf(line, "VmHWM: %zu", &kilobytes) == 1) break;
    fclose(f);
    return kilobytes * 1024;
}

static status write_picture(const char *path)
{
    img picture = {0};
    status s = bench_ball(&picture);
    if (s == OK) s = img_write_png(path, &picture, IMG_SRGB8);
    img_free(&picture);
    return s;
}

static int remove_entry(const char *path, const struct stat *info, int kind, struct FTW *place)
{
    (void)info;
    (void)kind;
    (void)place;
    return remove(path);
}

/* Reports what the program printed when it failed, in one line; code: as from wait4. */
static status explain(const char *errors, int code)
{
    char *text = NULL;
    size_t size;
    if (file_read(errors, 1 << 16, &text, &size) != OK) return fail(MERLIN_BAD_INPUT, "merlin estimate failed");
    text[strcspn(text, "\n")] = 0;
    status s = OK;
    if (*text)
        s = fail(MERLIN_BAD_INPUT, "%s", text);
    else if (WIFSIGNALED(code))
        s = fail(MERLIN_BAD_INPUT, "merlin estimate was ended by signal %d", WTERMSIG(code));
    else
        s = fail(MERLIN_BAD_INPUT, "merlin estimate ended with status %d", WEXITSTATUS(code));
    free(text);
    return s;
}

static const char *const part_names[BENCH_PARTS] = {"start",  "model",   "compile",  "read",  "mask", "prepare",
                                                    "choose", "network", "upsample", "write", "end"};

/* Reads the times from the program's report, which is one line; what its parts leave of the whole is its end. */
static status read_parts(const char *report, bench_estimation *run)
{
    char *text = NULL;
    size_t size;
    status s = file_read(report, 1 << 16, &text, &size);
    if (s != OK) return s;
    cJSON *json = cJSON_Parse(text), *seconds = cJSON_GetObjectItem(json, "seconds");
    double rest = run->seconds;
    for (int i = 0; i < BENCH_PARTS; i++) {
        const cJSON *part = cJSON_GetObjectItem(seconds, part_names[i]);
        bool last = i == BENCH_PARTS - 1;
        if (!last && !cJSON_IsNumber(part))
            s = fail(MERLIN_BAD_INPUT, "merlin estimate did not report its \"%s\"", part_names[i]);
        run->part[i] = (bench_part){part_names[i], last ? rest : cJSON_GetNumberValue(part)};
        rest -= run->part[i].seconds;
    }
    cJSON_Delete(json);
    free(text);
    return s;
}

/* Files of one measurement, all in a temporary folder. */
typedef struct bench_files {
    char *picture, *output, *report, *errors;
} bench_files;

/* Runs the program with its report and errors redirected to files. */
static status run_once(char *const *arguments, const bench_files *files, bench_estimation *run)
{
    posix_spawn_file_actions_t actions;
    if (posix_spawn_file_actions_init(&actions)) return fail(MERLIN_NO_MEMORY, "no memory to start %s", arguments[0]);
    enum { FRESH = O_WRONLY | O_CREAT | O_TRUNC };
    pid_t child;
    double started = clock_seconds();
    int refused = posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, files->report, FRESH, 0600);
    if (!refused) refused = posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, files->errors, FRESH, 0600);
    if (!refused) refused = posix_spawn(&child, arguments[0], &actions, NULL, arguments, environ);
    posix_spawn_file_actions_destroy(&actions);
    if (refused) return fail(MERLIN_BAD_INPUT, "cannot start %s: %s", arguments[0], strerror(refused));
    int code;
    struct rusage usage;
    pid_t ended;
    while ((ended = wait4(child, &code, 0, &usage)) < 0 && errno == EINTR)
        ;
    if (ended != child) return fail(MERLIN_BAD_INPUT, "lost sight of %s", arguments[0]);
    run->seconds = clock_seconds() - started;
    run->bytes = (size_t)usage.ru_maxrss * 1024;
    return WIFEXITED(code) && WEXITSTATUS(code) == 0 ? read_parts(files->report, run) : explain(files->errors, code);
}

static int compare_runs(const void *a, const void *b)
{
    const bench_estimation *x = a, *y = b;
    return (x->seconds > y->seconds) - (x->seconds < y->seconds);
}

static status run_often(const bench_files *files, const char *program, const char *weights, int runs,
                        bench_estimation *out)
{
    bench_estimation all[MAX_RUNS];
    char *const arguments[] = {(char *)program, "estimate", "--model",     (char *)weights,
                               files->picture,  "-o",       files->output, "--quiet",
                               "--json",        NULL};
    status s = write_picture(files->picture);
    size_t most = 0;
    if (runs > MAX_RUNS) runs = MAX_RUNS;
    for (int i = 0; s == OK && i < runs; i++) {
        s = run_once(arguments, files, &all[i]);
        if (s == OK && all[i].bytes > most) most = all[i].bytes;
    }
    if (s != OK) return s;
    qsort(all, (size_t)runs, sizeof all[0], compare_runs);
    *out = all[runs / 2];
    out->bytes = most;
    return OK;
}

static status run_in(const char *folder, const char *program, const char *weights, int runs, bench_estimation *out)
{
    bench_files files = {file_join(folder, "ball.png"), file_join(folder, "ball"), file_join(folder, "report.json"),
                         file_join(folder, "errors.txt")};
    status s;
    if (files.picture && files.output && files.report && files.errors)
        s = run_often(&files, program, weights, runs, out);
    else
        s = fail(MERLIN_NO_MEMORY, "no memory for a path");
    free(files.picture);
    free(files.output);
    free(files.report);
    free(files.errors);
    return s;
}

status bench_estimate(const char *program, const char *weights, int runs, bench_estimation *out)
{
    char *folder = file_in_scratch("merlin-bench-XXXXXX");
    if (!folder) return fail(MERLIN_NO_MEMORY, "no memory for a path");
    status s = OK;
    if (mkdtemp(folder)) {
        s = run_in(folder, program, weights, runs, out);
        nftw(folder, remove_entry, 16, FTW_DEPTH | FTW_PHYS);
    } else {
        s = fail(MERLIN_CANNOT_WRITE, "cannot make the folder %s", folder);
    }
    free(folder);
    return s;
}
