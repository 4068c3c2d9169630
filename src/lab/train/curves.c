/* SPDX-License-Identifier: MIT */
#include "lab/train/curves.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/file.h"
#include "image/write/figure.h"

enum { MAX_CSV_BYTES = 1 << 28, FIRST_LOSS = 4, COLUMNS = FIRST_LOSS + 1 + MODEL_LOSSES };

void train_losses_add(train_losses *l, const nn_program *p)
{
    l->total += (double)nn_total_loss(p);
    for (int i = 0; i < MODEL_LOSSES; i++)
        l->each[i] += (double)nn_loss(p, model_losses[i]);
    l->count++;
}

static void write_header(FILE *f)
{
    fprintf(f, "step,presentations,learning_rate,skipped,total");
    for (int i = 0; i < MODEL_LOSSES; i++)
        fprintf(f, ",%s", model_losses[i]);
    fputc('\n', f);
}

status train_curve_append(const char *path, const train_curve_row *row, const train_losses *l)
{
    FILE *f = fopen(path, "a");
    if (!f) return fail_by_errno(MERLIN_CANNOT_WRITE, "cannot append to %s", path);
    struct stat before;
    if (fstat(fileno(f), &before) == 0 && before.st_size == 0) write_header(f);
    double n = l->count ? (double)l->count : 1;
    fprintf(f, "%lld,%lld,%.6g,%lld,%.6g", (long long)row->step, (long long)row->presentations, row->learning_rate,
            (long long)row->skipped, l->total / n);
    for (int i = 0; i < MODEL_LOSSES; i++) {
        if (isnan(l->each[i]))
            fputc(',', f);
        else
            fprintf(f, ",%.6g", l->each[i] / n);
    }
    fputc('\n', f);
    bool bad = ferror(f) != 0;
    if (fclose(f) != 0 || bad) return fail_by_errno(MERLIN_CANNOT_WRITE, "cannot append to %s", path);
    return OK;
}

status train_curve_keep(const char *path)
{
    int file = open(path, O_RDONLY);
    if (file < 0) return errno == ENOENT ? OK : fail_by_errno(MERLIN_CANNOT_WRITE, "cannot open %s", path);
    bool good = fsync(file) == 0;
    close(file);
    return good ? OK : fail_by_errno(MERLIN_CANNOT_WRITE, "cannot write %s", path);
}

status train_curve_truncate(const char *path, int64_t step)
{
    if (!file_exists(path)) return OK;
    char *text = NULL;
    size_t size = 0, keep = 0;
    status s = file_read(path, MAX_CSV_BYTES, &text, &size);
    if (s != OK) return s;
    bool header = true;
    while (keep < size) {
        const char *end = memchr(text + keep, '\n', size - keep);
        if (!end || (!header && strtoll(text + keep, NULL, 10) > step)) break;
        header = false;
        keep = (size_t)(end - text) + 1;
    }
    s = file_write(path, text, keep);
    free(text);
    return s;
}

/* Columns of a CSV, stored row by row; empty fields are NaN. */
typedef struct table {
    float *value[COLUMNS];
    int rows;
} table;

static void free_table(table *t)
{
    for (int c = 0; c < COLUMNS; c++)
        free(t->value[c]);
}

static void read_row(const char *line, table *t)
{
    for (int c = 0; c < COLUMNS; c++) {
        char *end = (char *)line;
        /* a row of an earlier version may have fewer losses */
        float x = *line == '\n' || *line == 0 ? NAN : strtof(line, &end);
        t->value[c][t->rows] = end == line ? NAN : x;
        line = end + strcspn(end, ",\n");
        if (*line == ',') line++;
    }
    t->rows++;
}

static status read_table(const char *path, table *t)
{
    *t = (table){0};
    if (!file_exists(path)) return OK;
    char *text = NULL;
    size_t size = 0, lines = 1;
    status s = file_read(path, MAX_CSV_BYTES, &text, &size);
    if (s != OK) return s;
    for (size_t i = 0; i < size; i++)
        lines += text[i] == '\n';
    for (int c = 0; c < COLUMNS && s == OK; c++) {
        t->value[c] = malloc(lines * sizeof(float));
        if (!t->value[c]) s = fail(MERLIN_NO_MEMORY, "out of memory reading %s", path);
    }
    const char *line = s == OK ? strchr(text, '\n') : NULL;
    for (; line && line[1]; line = strchr(line + 1, '\n'))
        read_row(line + 1, t);
    free(text);
    return s;
}

static bool any_number(const float *x, int count)
{
    for (int i = 0; i < count; i++)
        if (!isnan(x[i])) return true;
    return false;
}

status train_curve_chart(const char *training_csv, const char *validation_csv, const char *png)
{
    table training = {0}, validation = {0};
    status s = read_table(training_csv, &training);
    if (s == OK) s = read_table(validation_csv, &validation);
    figure_curve curves[MODEL_LOSSES + 2];
    int count = 0;
    if (s == OK && training.rows) {
        for (int i = 0; i <= MODEL_LOSSES; i++) {
            const float *y = training.value[FIRST_LOSS + i];
            if (any_number(y, training.rows))
                curves[count++] =
                    (figure_curve){i ? model_losses[i - 1] : "training, total", training.value[1], y, training.rows};
        }
        if (validation.rows)
            curves[count++] =
                (figure_curve){"validation, total", validation.value[1], validation.value[FIRST_LOSS], validation.rows};
        s = figure_chart(png, "Losses", "presentations", "loss", true, curves, count);
    }
    free_table(&training);
    free_table(&validation);
    return s;
}
