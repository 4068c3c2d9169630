#include "eval/bench_estimate.h"

#include <fcntl.h>
#include <ftw.h>
#include <math.h>
#include <spawn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/file.h"
#include "base/progress.h"
#include "eval/maps.h"
#include "image/write.h"
#include "optics/camera.h"

extern char **environ;

enum { PICTURE = 256, MAX_RUNS = 32 };

void bench_reset_resident(void)
{
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

/* The maps of a ball of radius 0.4 about (0, 0, -1.2), with rings of two colours. */
static void draw_ball(eval_maps *maps, img *mask)
{
    camera view = {PICTURE, PICTURE, 60};
    vec3 centre = {0, 0, -1.2f};
    for (int y = 0; y < PICTURE; y++) {
        for (int x = 0; x < PICTURE; x++) {
            vec3 d = camera_ray(&view, (float)x + 0.5f, (float)y + 0.5f);
            float along = vec3_dot(d, centre), inside = along * along - vec3_dot(centre, centre) + 0.4f * 0.4f;
            if (inside <= 0) continue;
            vec3 p = vec3_scale(d, along - sqrtf(inside)), n = vec3_scale(vec3_sub(p, centre), 1 / 0.4f);
            float ring = sinf(20 * p.y) > 0 ? 0.6f : -0.4f;
            memcpy(img_at(&maps->albedo, x, y), (float[3]){ring, 0.2f, -ring}, 3 * sizeof(float));
            memcpy(img_at(&maps->normal, x, y), (float[3]){n.x, n.y, n.z}, 3 * sizeof(float));
            *img_at(&maps->roughness, x, y) = -0.2f;
            *img_at(&maps->depth, x, y) = -p.z;
            *img_at(mask, x, y) = 1;
        }
    }
}

static status write_picture(const char *path)
{
    eval_maps maps;
    img mask, picture = {0};
    status s = eval_maps_new(&maps, PICTURE, PICTURE);
    if (s != OK) return s;
    s = img_new(&mask, PICTURE, PICTURE, 1);
    if (s == OK) {
        draw_ball(&maps, &mask);
        s = eval_render(&maps, &mask, 60, 5.95f, &(eval_lighting){{0, 0, 0}, NULL}, &picture);
        if (s == OK) s = img_write_png(path, &picture, IMG_SRGB8);
    }
    img_free(&picture);
    img_free(&mask);
    eval_maps_free(&maps);
    return s;
}

static int remove_entry(const char *path, const struct stat *info, int kind, struct FTW *place)
{
    (void)info;
    (void)kind;
    (void)place;
    return remove(path);
}

/* What the program said when it failed, in one line. */
static status explain(const char *errors, int code)
{
    char *text = NULL;
    size_t size;
    if (file_read(errors, 1 << 16, &text, &size) != OK) return fail(ERROR_INPUT, "merlin estimate failed");
    text[strcspn(text, "\n")] = 0;
    status s = *text ? fail(ERROR_INPUT, "%s", text) : fail(ERROR_INPUT, "merlin estimate ended with status %d", code);
    free(text);
    return s;
}

/* Runs the program, its standard output thrown away and its errors kept in a file. */
static status run_once(char *const *arguments, const char *errors, double *seconds, size_t *bytes)
{
    posix_spawn_file_actions_t actions;
    if (posix_spawn_file_actions_init(&actions)) return fail(ERROR_MEMORY, "no memory to start %s", arguments[0]);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, errors, O_WRONLY | O_CREAT | O_TRUNC, 0600);
    pid_t child;
    double started = clock_seconds();
    int refused = posix_spawn(&child, arguments[0], &actions, NULL, arguments, environ);
    posix_spawn_file_actions_destroy(&actions);
    if (refused) return fail(ERROR_INPUT, "cannot start %s: %s", arguments[0], strerror(refused));
    int code;
    struct rusage usage;
    if (wait4(child, &code, 0, &usage) != child) return fail(ERROR_INPUT, "lost sight of %s", arguments[0]);
    *seconds = clock_seconds() - started;
    *bytes = (size_t)usage.ru_maxrss * 1024;
    return WIFEXITED(code) && WEXITSTATUS(code) == 0 ? OK : explain(errors, code);
}

static int compare_seconds(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* The files of one measurement, all in the temporary folder. */
typedef struct bench_files {
    char *picture, *output, *errors;
} bench_files;

static status run_often(const bench_files *files, const char *program, const char *weights, int runs, double *seconds,
                        size_t *bytes)
{
    double times[MAX_RUNS];
    char *const arguments[] = {(char *)program, "estimate", "--model", (char *)weights, files->picture, "-o",
                               files->output,   "--quiet",  NULL};
    status s = write_picture(files->picture);
    *bytes = 0;
    if (runs > MAX_RUNS) runs = MAX_RUNS;
    for (int i = 0; s == OK && i < runs; i++) {
        size_t held = 0;
        s = run_once(arguments, files->errors, &times[i], &held);
        if (held > *bytes) *bytes = held;
    }
    if (s != OK) return s;
    qsort(times, (size_t)runs, sizeof times[0], compare_seconds);
    *seconds = times[runs / 2];
    return OK;
}

static status run_in(const char *folder, const char *program, const char *weights, int runs, double *seconds,
                     size_t *bytes)
{
    bench_files files = {file_join(folder, "ball.png"), file_join(folder, "ball"), file_join(folder, "errors.txt")};
    status s;
    if (files.picture && files.output && files.errors)
        s = run_often(&files, program, weights, runs, seconds, bytes);
    else
        s = fail(ERROR_MEMORY, "no memory for a path");
    free(files.picture);
    free(files.output);
    free(files.errors);
    return s;
}

status bench_estimate(const char *program, const char *weights, int runs, double *seconds, size_t *bytes)
{
    const char *where = getenv("TMPDIR");
    char *folder = file_join(where && *where ? where : "/tmp", "merlin-bench-XXXXXX");
    if (!folder) return fail(ERROR_MEMORY, "no memory for a path");
    status s = OK;
    if (mkdtemp(folder)) {
        s = run_in(folder, program, weights, runs, seconds, bytes);
        nftw(folder, remove_entry, 16, FTW_DEPTH | FTW_PHYS);
    } else {
        s = fail(ERROR_OUTPUT, "cannot make the folder %s", folder);
    }
    free(folder);
    return s;
}
