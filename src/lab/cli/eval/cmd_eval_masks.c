/* SPDX-License-Identifier: MIT */
/* merlin-lab eval masks: how well objects are found in photographs without a mask, and how well the result's quality is
 * predicted. */
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/api_needs.h"
#include "base/file.h"
#include "command/cli.h"
#include "command/json_line.h"
#include "command/options.h"
#include "command/photos.h"
#include "lab/cli/eval/eval_commands.h"
#include "lab/eval/tables/mask_table.h"
#include "merlin/merlin.h"

static const char help[] =
    "usage: merlin-lab eval masks [PHOTO|FOLDER...] [--data DIR] [options]\n\n"
    "How well merlin estimate finds the object of a photograph without a mask: intersection over union of what is "
    "found\n"
    "and a mask that is known, and how far the confidence can be trusted. Samples (merlin-lab render) become "
    "photographs\n"
    "by backgrounds made here: the dark, a wall, a floor, a textured desk, a room full of things.\n\n"
    "      --data DIR    samples; each makes five pictures\n"
    "      --mask M      the photographs' masks, as in merlin estimate (default: those beside the photographs)\n"
    "      --count N     only the first N samples\n"
    "      --seed S      other backgrounds (default 1)\n"
    "      --json        report on standard output as JSON, picture by picture\n"
    "  -t, --threads N   how many threads work (default: one a processor)\n"
    "  -q, --quiet       no progress\n"
    "  -h, --help        this text\n\n"
    "Photographs without a mask are left out. Goes on after one that fails, and then exits with 1.\n";

typedef struct request {
    const char *data, *mask;
    size_t count;
    uint64_t seed;
    bool json, quiet, help;
} request;

/* State of the evaluation. */
typedef struct run {
    const request *request;
    photo_list photos;
    char **samples;
    size_t sample_count, failures;
    mask_table table;
    progress progress;
} run;

static status parse(int *argc, char ***argv, request *r)
{
    const cli_option options[] = {
        {"data", .text = &r->data},
        {"mask", .text = &r->mask},
        {"count", .count = &r->count, .low = 1, .high = 1000000},
        {"seed", .whole = &r->seed, .low = 0, .high = 1000000000},
        {"json", .flag = &r->json},
        {"quiet", 'q', .flag = &r->quiet},
        {"help", 'h', .flag = &r->help},
        {0},
    };
    status s = cli_read_options(argc, argv, options);
    if (s != OK || r->help) return s;
    if (r->mask && *argc == 0) return fail(MERLIN_WRONG_USE, "--mask is of photographs, and none is given");
    return *argc > 0 || r->data ? OK
                                : fail(MERLIN_WRONG_USE, "nothing to search: give photographs with masks, or --data");
}

/* ---- photographs ---- */

static status read_mask(const photo_job *job, merlin_image *alpha, merlin_image *mask)
{
    if (job->mask) return merlin_mask_read(job->mask, mask);
    *mask = *alpha;
    *alpha = (merlin_image){0};
    return OK;
}

static status add_photo(run *r, const photo_job *job)
{
    merlin_image photo, alpha, mask = {0};
    status s = merlin_image_read(job->photo, &photo, &alpha);
    if (s != OK) return s;
    s = read_mask(job, &alpha, &mask);
    img picture = photo, known = mask;
    if (s == OK && mask.data) {
        mask_truth truth = {file_name_of(job->photo), MASK_PHOTO, &picture, &known, NULL};
        s = mask_table_add(&r->table, &truth);
    }
    merlin_image_free(&photo);
    merlin_image_free(&alpha);
    merlin_image_free(&mask);
    return s;
}

static status add_photos(run *r)
{
    for (size_t i = 0; i < r->photos.count; i++) {
        status s = add_photo(r, &r->photos.at[i]);
        if (s == MERLIN_NO_MEMORY) return s;
        if (s != OK) {
            cli_fail("eval masks", s);
            r->failures++;
        }
        progress_update(&r->progress, i + 1, NULL);
        if (cli_interrupted()) return fail(MERLIN_STOPPED, "interrupted");
    }
    return OK;
}

/* ---- all of it ---- */

static status list_pictures(run *r, char *const *arguments, int count)
{
    const request *q = r->request;
    status s = OK;
    if (count > 0) s = photo_list_make(arguments, count, q->mask, NULL, &r->photos);
    if (!q->quiet) photo_list_tell(&r->photos, "eval masks");
    if (s == OK && q->data) s = sample_list(q->data, &r->samples, &r->sample_count);
    return s;
}

static status evaluate(run *r)
{
    const request *q = r->request;
    size_t samples = q->count && q->count < r->sample_count ? q->count : r->sample_count;
    progress_begin(&r->progress, "searching", "pictures", 0, r->photos.count + samples * COMPOSITE_KINDS, q->quiet);
    status s = add_photos(r);
    if (s == OK) s = mask_table_add_samples(&r->table, r->samples, samples, q->seed, &r->progress, cli_interrupted);
    progress_end(&r->progress);
    if (s == OK && r->table.count == 0 && r->failures == 0)
        s = fail(MERLIN_BAD_INPUT, "none of the photographs has a mask to hold what is found against");
    if (s != OK || r->table.count == 0) return s;
    return q->json ? json_report_print(mask_table_json(&r->table)) : mask_table_print(&r->table, stdout);
}

int eval_masks(int argc, char **argv)
{
    request r = {.seed = 1};
    if (parse(&argc, &argv, &r) != OK) return cli_usage("eval masks", "%s", status_message());
    if (r.help) return fputs(help, stdout) < 0;
    cli_catch_interrupts();
    run work = {.request = &r};
    status s = list_pictures(&work, argv, argc);
    if (s == OK) s = evaluate(&work);
    mask_table_free(&work.table);
    photo_list_free(&work.photos);
    file_list_free(work.samples, work.sample_count);
    if (s != OK) return cli_fail("eval masks", s);
    return work.failures > 0;
}
