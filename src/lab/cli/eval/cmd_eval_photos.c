/* SPDX-License-Identifier: MIT */
/* merlin-lab eval photos: estimates of photographs by several weights, side by side in one picture. */
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/file.h"
#include "base/progress.h"
#include "command/check_files.h"
#include "command/cli.h"
#include "command/options.h"
#include "command/photo_ahead.h"
#include "estimate/files/overview.h"
#include "estimate/photo/model_pair.h"
#include "image/resize.h"
#include "lab/cli/eval/eval_commands.h"

static const char help[] =
    "usage: merlin-lab eval photos PHOTO|FOLDER... --model W [--model W2 ...] -o FILE.png\n\n"
    "Real photographs have no truth to measure against, but can be looked at: a row a photograph, with the photograph "
    "and\n"
    "then albedo, normal, roughness, depth, reconstruction and two new lights, each by all of the weights side by "
    "side.\n\n"
    "      --model W        weights, a file or a shipped name; once for each column of tiles, before and after say, at "
    "most 4\n"
    "  -o, --output F.png   the picture\n"
    "      --mask M         as in merlin estimate (default: those beside the photographs)\n"
    "  -t, --threads N      how many threads work (default: one a processor)\n"
    "  -q, --quiet          no other output than errors\n"
    "  -h, --help           this text\n\n"
    "Goes on after a photograph that fails, leaves it out, and then exits with 1.\n";

enum { MOST_MODELS = 4, MOST_PHOTOS = 64, TILE = 160, LABEL_SIZE = 48 };
typedef struct request {
    const char *models[MOST_MODELS], *mask, *output;
    int model_count;
    bool quiet, help;
} request;

static status take_model(const char *path, void *into)
{
    request *r = into;
    if (r->model_count == MOST_MODELS) return fail(MERLIN_WRONG_USE, "at most %d weights at a time", MOST_MODELS);
    r->models[r->model_count++] = path;
    return OK;
}

static status parse(int *argc, char ***argv, request *r)
{
    const cli_option options[] = {
        {"model", .take = take_model, .into = r, .many = true},
        {"mask", .text = &r->mask},
        {"output", 'o', .picture = &r->output},
        {"quiet", 'q', .flag = &r->quiet},
        {"help", 'h', .flag = &r->help},
        {0},
    };
    status s = cli_read_options(argc, argv, options);
    if (s != OK || r->help) return s;
    if (*argc == 0) return fail(MERLIN_WRONG_USE, "no photograph given");
    if (r->model_count == 0) return fail(MERLIN_WRONG_USE, "--model W is missing");
    return r->output ? OK : fail(MERLIN_WRONG_USE, "-o FILE.png is missing");
}

/* ---- the picture ---- */

/* The picture: a row for each photograph, with the photograph and then each other tile by every weights file. */
typedef struct comparison {
    const request *request;
    const photo_list *photos;
    int columns;
    img *images;                /* photographs × columns, of the tiles' size */
    char (*labels)[LABEL_SIZE]; /* a label for each */
    bool *failed;               /* per photograph: left out of the picture */
    size_t failures;            /* number of those left out */
    progress progress;
} comparison;

static size_t tile_count(const comparison *c)
{
    return c->photos->count * (size_t)c->columns;
}

static status comparison_new(const request *r, const photo_list *photos, comparison *c)
{
    *c = (comparison){.request = r, .photos = photos, .columns = 1 + (OVERVIEW_TILES - 1) * r->model_count};
    if (photos->count < 1 || photos->count > MOST_PHOTOS)
        return fail(MERLIN_WRONG_USE, "%zu photographs do not fit in one picture; 1 to %d do", photos->count,
                    MOST_PHOTOS);
    c->images = calloc(tile_count(c), sizeof *c->images);
    c->labels = calloc(tile_count(c), sizeof *c->labels);
    c->failed = calloc(photos->count, sizeof *c->failed);
    return c->images && c->labels && c->failed ? OK : fail(MERLIN_NO_MEMORY, "no memory for %zu tiles", tile_count(c));
}

static void comparison_free(comparison *c)
{
    for (size_t i = 0; c->images && i < tile_count(c); i++)
        img_free(&c->images[i]);
    free(c->images);
    free(c->labels);
    free(c->failed);
}

static status put_tiles(comparison *c, size_t photo, int model, const overview *o)
{
    figure_tile tiles[OVERVIEW_TILES];
    overview_tiles(o, tiles);
    int models = c->request->model_count;
    for (int t = model == 0 ? 0 : 1; t < OVERVIEW_TILES; t++) {
        size_t at = photo * (size_t)c->columns + (size_t)(t == 0 ? 0 : 1 + (t - 1) * models + model);
        status s = img_resize(tiles[t].image, TILE, TILE, &c->images[at]);
        if (s != OK) return s;
        if (t == 0 || models == 1)
            snprintf(c->labels[at], LABEL_SIZE, "%s", tiles[t].label);
        else
            snprintf(c->labels[at], LABEL_SIZE, "%d: %s", model + 1, tiles[t].label);
    }
    return OK;
}

static status take_apart(comparison *c, merlin_model *m, size_t photo, int model)
{
    const photo_job *job = &c->photos->at[photo];
    merlin_maps maps = {0};
    overview o = {0};
    status s = photo_maps(m, job->photo, job->mask, NULL, &maps);
    if (s == OK) s = overview_new(model_network(m, &maps, MERLIN_BY_BRDF), &maps, &o);
    if (s == OK) s = put_tiles(c, photo, model, &o);
    overview_free(&o);
    merlin_maps_free(&maps);
    return s;
}

/* Leaves a photograph that failed out, as the rows of the others are still useful. */
static void leave_out_bad(comparison *c, size_t photo, status s)
{
    if (s == OK) return;
    c->failed[photo] = true;
    c->failures++;
    cli_fail("eval photos", s);
}

static void leave_out_missing(comparison *c)
{
    for (size_t i = 0; i < c->photos->count; i++)
        leave_out_bad(c, i, check_photo_and_mask(c->photos->at[i].photo, c->photos->at[i].mask));
}

static status run_model(comparison *c, int model)
{
    merlin_model *m = NULL;
    size_t count = c->photos->count;
    char *weights = NULL;
    status s = photo_find_model(c->request->models[model], &weights);
    if (s == OK) s = merlin_model_open(weights, &m);
    free(weights);
    for (size_t i = 0; i < count && s == OK; i++) {
        if (cli_interrupted()) s = fail(MERLIN_STOPPED, "interrupted; nothing was written");
        if (s == OK && !c->failed[i]) leave_out_bad(c, i, take_apart(c, m, i, model));
        if (s == OK) progress_update(&c->progress, (size_t)model * count + i + 1, NULL);
    }
    merlin_model_close(m);
    return s;
}

static status write_sheet(const comparison *c)
{
    size_t count = 0;
    figure_tile *tiles = malloc(tile_count(c) * sizeof *tiles);
    if (!tiles) return fail(MERLIN_NO_MEMORY, "no memory for %zu tiles", tile_count(c));
    for (size_t i = 0; i < tile_count(c); i++)
        if (!c->failed[i / (size_t)c->columns]) tiles[count++] = (figure_tile){c->labels[i], &c->images[i]};
    status s = figure_sheet(c->request->output, tiles, (int)count, c->columns, TILE);
    free(tiles);
    return s;
}

static status show(const comparison *c)
{
    size_t shown = c->photos->count - c->failures;
    if (shown == 0) return OK; /* each failure has been reported */
    status s = write_sheet(c);
    if (s == OK && !c->request->quiet)
        printf("%s: %zu photographs by %d weights\n", c->request->output, shown, c->request->model_count);
    return s;
}

/* Compares the weights. *failures: number of photographs that are not in the picture. */
static status compare(const request *r, const photo_list *photos, size_t *failures)
{
    comparison c;
    status s = comparison_new(r, photos, &c);
    if (s == OK) {
        leave_out_missing(&c);
        bool any = c.failures < photos->count;
        progress_begin(&c.progress, "taking apart", "photographs", 0, photos->count * (size_t)r->model_count,
                       r->quiet || !any);
        for (int model = 0; any && model < r->model_count && s == OK; model++)
            s = run_model(&c, model);
        progress_end(&c.progress);
    }
    if (s == OK) s = show(&c);
    *failures = c.failures;
    comparison_free(&c);
    return s;
}

static status check_apart(const request *r, const photo_list *photos)
{
    for (size_t i = 0; i < photos->count; i++)
        if (file_is_same(r->output, photos->at[i].photo) ||
            (photos->at[i].mask && file_is_same(r->output, photos->at[i].mask)))
            return fail(MERLIN_WRONG_USE, "-o %s is one of the photographs or masks", r->output);
    return OK;
}

/* Checks all weights before any work: the last of them would be opened only after all others have been used. */
static status check_models(const request *r)
{
    status s = OK;
    for (int i = 0; i < r->model_count && s == OK; i++) {
        char *weights = NULL;
        s = photo_find_model(r->models[i], &weights);
        if (s == OK) s = check_named("weights file", weights);
        free(weights);
    }
    return s;
}

int eval_photos(int argc, char **argv)
{
    request r = {0};
    if (parse(&argc, &argv, &r) != OK) return cli_usage("eval photos", "%s", status_message());
    if (r.help) return fputs(help, stdout) < 0;
    photo_list photos;
    status s = file_check_writable(r.output);
    if (s == OK) s = photo_list_make(argv, argc, r.mask, NULL, &photos);
    if (s != OK) return cli_fail("eval photos", s);
    if (!r.quiet) photo_list_tell(&photos, "eval photos");
    cli_catch_interrupts();
    size_t failures = 0;
    s = check_apart(&r, &photos);
    if (s == OK) s = check_models(&r);
    if (s == OK) s = compare(&r, &photos, &failures);
    photo_list_free(&photos);
    return s == OK ? failures > 0 : cli_fail("eval photos", s);
}
