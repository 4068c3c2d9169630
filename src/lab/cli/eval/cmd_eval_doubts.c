/* SPDX-License-Identifier: MIT */
/* merlin-lab eval doubts: how often a photograph's warnings are right. */
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/file.h"
#include "base/progress.h"
#include "command/check_files.h"
#include "command/cli.h"
#include "command/json_line.h"
#include "command/options.h"
#include "command/photo_ahead.h"
#include "estimate/photo/model_pair.h"
#include "lab/cli/eval/eval_commands.h"
#include "lab/eval/tables/doubt_table.h"
#include "lab/render/sample.h"

static const char help[] =
    "usage: merlin-lab eval doubts [--right PHOTO|DIR] [--wrong PHOTO|DIR] [--data DIR] [options]\n\n"
    "How often merlin estimate doubts a photograph's light, or anything of it, where it should and where it should "
    "not:\n"
    "on photographs of which it is known, and on samples under other lights than the flash.\n\n"
    "      --right P        a photograph, or a folder of them, lit by a flash at the lens\n"
    "      --wrong P        a photograph or a folder of others: another light, no object\n"
    "      --data DIR       samples: merlin-lab render --targets K, whose environments and lamps are wrong light\n"
    "      --count N        only the first N samples\n"
    "      --model W        weights (default: those merlin estimate takes)\n"
    "      --json           report on standard output as JSON, with the cues that each judgement is made of\n"
    "  -t, --threads N      how many threads work (default: one a processor)\n"
    "  -q, --quiet          no progress\n"
    "  -h, --help           this text\n\n"
    "Masks beside photographs are taken as in merlin estimate. Goes on after a photograph that fails, and then exits "
    "with 1.\n";

typedef struct request {
    const char *right, *wrong, *data, *weights;
    size_t count;
    bool json, quiet, help;
} request;

/* State of the evaluation. */
typedef struct run {
    const request *request;
    merlin_model *model;
    doubt_table table;
    progress progress;
    size_t done, failures;
} run;

static status parse(int argc, char **argv, request *r)
{
    const cli_option options[] = {
        {"right", .text = &r->right},
        {"wrong", .text = &r->wrong},
        {"data", .text = &r->data},
        {"count", .count = &r->count, .low = 1, .high = 1000000},
        {"model", .text = &r->weights},
        {"json", .flag = &r->json},
        {"quiet", 'q', .flag = &r->quiet},
        {"help", 'h', .flag = &r->help},
        {0},
    };
    status s = cli_read_options(&argc, &argv, options);
    if (s != OK || r->help) return s;
    if (argc > 0) return fail(MERLIN_WRONG_USE, "unexpected argument \"%s\"", argv[0]);
    return r->right || r->wrong || r->data
               ? OK
               : fail(MERLIN_WRONG_USE, "nothing to judge: give --right, --wrong or --data");
}

static status step(run *r)
{
    progress_update(&r->progress, ++r->done, NULL);
    return cli_interrupted() ? fail(MERLIN_STOPPED, "interrupted") : OK;
}

static status add_photos(run *r, const photo_list *photos, doubt_kind kind)
{
    status s = OK;
    for (size_t i = 0; i < photos->count && s == OK; i++) {
        doubt_photo photo = {.name = file_name_of(photos->at[i].photo), .kind = kind};
        photo_taken taken;
        status one = photo_take(&photos->at[i], &taken);
        photo.picture = taken.photo;
        photo.object = taken.object;
        photo.shot = taken.shot;
        if (one == OK) one = doubt_table_add(&r->table, r->model, &photo);
        if (one == MERLIN_NO_MEMORY) return one;
        if (one != OK) {
            cli_fail("eval doubts", one);
            r->failures++;
        }
        s = step(r);
    }
    return s;
}

static status add_samples(run *r, char *const *paths, size_t count)
{
    status s = OK;
    for (size_t i = 0; i < count && s == OK; i++) {
        s = doubt_table_add_sample(&r->table, r->model, paths[i]);
        if (s == OK) s = step(r);
    }
    return s;
}

/* Pictures to be evaluated: photographs of both kinds, and samples. */
typedef struct pictures {
    photo_list right, wrong;
    char **samples;
    size_t count;
} pictures;

static status list_pictures(const request *r, pictures *p)
{
    *p = (pictures){0};
    status s = check_named("photograph or folder", r->right);
    if (s == OK) s = check_named("photograph or folder", r->wrong);
    if (s == OK && r->right) s = photo_list_make((char *[]){(char *)r->right}, 1, NULL, NULL, &p->right);
    if (s == OK && r->wrong) s = photo_list_make((char *[]){(char *)r->wrong}, 1, NULL, NULL, &p->wrong);
    if (!r->quiet) photo_list_tell(&p->right, "eval doubts");
    if (!r->quiet) photo_list_tell(&p->wrong, "eval doubts");
    if (s == OK && r->data) s = sample_list(r->data, &p->samples, &p->count);
    return s;
}

static void pictures_free(pictures *p)
{
    photo_list_free(&p->right);
    photo_list_free(&p->wrong);
    file_list_free(p->samples, p->count);
}

static status evaluate(run *r, const pictures *p)
{
    size_t samples = r->request->count && r->request->count < p->count ? r->request->count : p->count;
    size_t all = p->right.count + p->wrong.count + samples;
    progress_begin(&r->progress, "judging", "pictures", 0, all, r->request->quiet);
    status s = add_photos(r, &p->right, DOUBT_RIGHT_PHOTO);
    if (s == OK) s = add_photos(r, &p->wrong, DOUBT_WRONG_PHOTO);
    if (s == OK) s = add_samples(r, p->samples, samples);
    progress_end(&r->progress);
    if (s != OK) return s;
    if (r->request->json) return json_report_print(doubt_table_json(&r->table));
    doubt_table_print(&r->table, stdout);
    return OK;
}

int eval_doubts(int argc, char **argv)
{
    request r = {0};
    if (parse(argc, argv, &r) != OK) return cli_usage("eval doubts", "%s", status_message());
    if (r.help) return fputs(help, stdout) < 0;
    cli_catch_interrupts();
    run work = {.request = &r};
    pictures all;
    char *weights = NULL, *flash = NULL;
    status s = list_pictures(&r, &all);
    if (s == OK) s = photo_find_models(r.weights, &weights, &flash);
    if (s == OK) s = model_open_pair(weights, flash, &work.model);
    if (s == OK) s = evaluate(&work, &all);
    merlin_model_close(work.model);
    doubt_table_free(&work.table);
    pictures_free(&all);
    free(weights);
    free(flash);
    if (s != OK) return cli_fail("eval doubts", s);
    return work.failures > 0;
}
