/* SPDX-License-Identifier: MIT */
/* sequence.json: what a sequence's frames have in common, and how each was processed. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/api_needs.h"
#include "base/file.h"
#include "base/json/json_put.h"
#include "base/text/report.h"
#include "base/warnings.h"
#include "sequence/sequence.h"

static const char report_name[] = "sequence.json";

int merlin_sequence_folder(long number, char *text, int size)
{
    return snprintf(text, size > 0 ? (size_t)size : 0, "frame_%04ld", number);
}

/* ---- warnings ---- */

static long count_frames(const merlin_sequence *q, bool lost)
{
    long count = 0;
    for (size_t i = 0; i < q->count; i++)
        count += lost ? q->frames[i].facts.object == MERLIN_OBJECT_LOST : q->frames[i].facts.cut != 0;
    return count;
}

static long first_frame(const merlin_sequence *q, bool lost)
{
    for (size_t i = 0; i < q->count; i++)
        if (lost ? q->frames[i].facts.object == MERLIN_OBJECT_LOST : q->frames[i].facts.cut != 0)
            return q->frames[i].facts.number;
    return 0;
}

void merlin_sequence_warnings(const merlin_sequence *sequence, const merlin_frames_head *head, merlin_warnings *out)
{
    if (out) *out = (merlin_warnings){.count = 0};
    if (!sequence || !out) return;
    const long lost = count_frames(sequence, true), cuts = count_frames(sequence, false);
    if (lost)
        warnings_add(
            out, "object_lost",
            "in %ld of %zu frames, first in %ld, the object was not found again and is taken to be where it was; "
            "give masks",
            lost, sequence->count, first_frame(sequence, true));
    if (head && head->missing)
        warnings_add(out, "frames_missing", "frames are missing (%ld), first %ld", head->missing, head->first_gap);
    if (cuts)
        warnings_add(out, "cuts", "another scene begins in %ld of %zu frames, first in %ld", cuts, sequence->count,
                     first_frame(sequence, false));
    if (head && head->interlaced)
        warnings_add(out, "interlaced", "odd and even lines are from different times; deinterlace the video first");
    for (int i = 0; i < SEQUENCE_DOUBTS; i++) {
        const sequence_doubt *d = &sequence->doubts[i];
        if (!d->frames) continue;
        const char *code = merlin_doubt_code((merlin_doubt)(1u << i));
        if ((size_t)d->frames == sequence->count)
            warnings_add(out, code, "in all %zu frames: %s", sequence->count, d->message);
        else
            warnings_add(out, code, "in %ld of %zu frames: %s", d->frames, sequence->count, d->message);
    }
}

/* ---- the report ---- */

static void put_differences(cJSON *to, const char *name, const merlin_differences *d)
{
    cJSON *o = json_put_object(to, name);
    json_put_number(o, "photo", d->photo);
    json_put_number(o, "albedo", d->albedo);
    json_put_number(o, "normal", d->normal);
    json_put_number(o, "roughness", d->roughness);
    json_put_number(o, "depth", d->depth);
    json_put_number(o, "mask", d->mask);
}

static void put_flicker(cJSON *root, const merlin_sequence *q)
{
    merlin_flicker f;
    merlin_sequence_flicker(q, &f);
    cJSON *o = json_put_object(root, "flicker");
    json_put_number(o, "pairs", (double)f.pairs);
    if (!f.pairs) return;
    put_differences(o, "before", &f.before);
    put_differences(o, "after", &f.after);
}

static void put_frame(cJSON *frames, const sequence_frame *f)
{
    static const char *const objects[] = {"given", "found", "followed", "lost"};
    char folder[64];
    cJSON *o = json_append_object(frames);
    merlin_sequence_folder(f->facts.number, folder, sizeof folder);
    json_put_number(o, "number", (double)f->facts.number);
    json_put_text(o, "folder", folder);
    json_put_text(o, "object", objects[f->facts.object]);
    json_put_number(o, "overlap", (double)f->facts.overlap);
    json_put_number(o, "confidence", (double)f->confidence);
    cJSON *exposure = json_put_array(o, "exposure"), *shift = json_put_array(o, "shift");
    for (int c = 0; c < 3; c++)
        json_append(exposure, cJSON_CreateNumber((double)f->facts.exposure[c]));
    for (int c = 0; c < 2; c++)
        json_append(shift, cJSON_CreateNumber(f->facts.shift[c]));
    cJSON *crop = json_put_object(o, "crop");
    json_put_number(crop, "x", f->crop.x);
    json_put_number(crop, "y", f->crop.y);
    json_put_number(crop, "side", f->crop.side);
    json_put_number(o, "gain", (double)f->gain);
    json_put_number(o, "kept", (double)f->facts.kept);
    json_put_bool(o, "cut", f->facts.cut != 0);
}

merlin_status merlin_sequence_report(const merlin_sequence *sequence, const merlin_frames_head *head, char **text)
{
    if (text) *text = NULL;
    status s = api_needs(__func__, sequence && text);
    if (s != OK) return s;
    warnings doubts;
    merlin_sequence_warnings(sequence, head, &doubts);
    cJSON *root = report_begin(&doubts);
    json_put_number(root, "width", sequence->meter.width);
    json_put_number(root, "height", sequence->meter.height);
    if (head && head->rate > 0) json_put_number(root, "rate", head->rate);
    json_put_text(root, "model", sequence->network);
    json_put_number(root, "smooth", sequence->smooth);
    json_put_bool(root, "apart", sequence->apart);
    put_flicker(root, sequence);
    cJSON *frames = json_put_array(root, "frames");
    for (size_t i = 0; i < sequence->count; i++)
        put_frame(frames, &sequence->frames[i]);
    *text = json_print(root);
    cJSON_Delete(root);
    return *text ? OK : fail(MERLIN_NO_MEMORY, "no memory for a report");
}

merlin_status merlin_sequence_write(const merlin_sequence *sequence, const merlin_frames_head *head, const char *folder)
{
    char *text = NULL;
    status s = api_needs(__func__, sequence && folder);
    if (s == OK) s = merlin_sequence_report(sequence, head, &text);
    char *path = s == OK ? file_join(folder, report_name) : NULL;
    if (s == OK && !path) s = fail(MERLIN_NO_MEMORY, "no memory for a file name");
    if (s == OK) s = file_write(path, text, strlen(text));
    free(path);
    free(text);
    return s;
}

/* ---- reading ---- */

int merlin_sequence_is(const char *folder)
{
    return folder && file_is_folder(folder) && file_is_in(folder, report_name);
}

/* Adds a frame of the list; false for one that is none. */
static status add_frame(const char *folder, const cJSON *item, merlin_sequence_files *out)
{
    const cJSON *number = cJSON_GetObjectItem(item, "number");
    char name[64];
    if (!cJSON_IsNumber(number) || !(number->valuedouble >= 0 && number->valuedouble < 1e15))
        return fail(MERLIN_BAD_INPUT, "%s/%s is damaged: a frame has no number", folder, report_name);
    merlin_sequence_file *f = &out->at[out->count];
    f->number = (long)number->valuedouble;
    merlin_sequence_folder(f->number, name, sizeof name);
    f->folder = file_join(folder, name);
    if (!f->folder) return fail(MERLIN_NO_MEMORY, "no memory for a file name");
    out->count++;
    if (!file_is_in(f->folder, "maps.exr"))
        return fail(MERLIN_BAD_INPUT, "there are no maps in %s, which %s lists", f->folder, report_name);
    return OK;
}

merlin_status merlin_sequence_read(const char *folder, merlin_sequence_files *out)
{
    enum { LARGEST = 256 << 20 };
    if (out) *out = (merlin_sequence_files){.rate = 0};
    status s = api_needs(__func__, folder && out);
    char *path = s == OK ? file_join(folder, report_name) : NULL, *text = NULL;
    size_t size = 0;
    if (s == OK && !path) s = fail(MERLIN_NO_MEMORY, "no memory for a file name");
    if (s == OK) s = file_read(path, LARGEST, &text, &size);
    free(path);
    if (s != OK) return s;
    cJSON *root = cJSON_Parse(text);
    free(text);
    const cJSON *frames = cJSON_GetObjectItem(root, "frames"), *rate = cJSON_GetObjectItem(root, "rate"), *item = NULL;
    const int count = cJSON_IsArray(frames) ? cJSON_GetArraySize(frames) : 0;
    if (count < 1) s = fail(MERLIN_BAD_INPUT, "%s/%s is damaged: it lists no frames", folder, report_name);
    if (s == OK) out->at = calloc((size_t)count, sizeof *out->at);
    if (s == OK && !out->at) s = fail(MERLIN_NO_MEMORY, "no memory for the frames of %s", folder);
    if (cJSON_IsNumber(rate) && rate->valuedouble > 0 && rate->valuedouble < 1e4) out->rate = rate->valuedouble;
    cJSON_ArrayForEach(item, frames) if (s == OK) s = add_frame(folder, item, out);
    cJSON_Delete(root);
    if (s != OK) merlin_sequence_files_free(out);
    return s;
}

void merlin_sequence_files_free(merlin_sequence_files *files)
{
    if (!files) return;
    for (size_t i = 0; i < files->count; i++)
        free(files->at[i].folder);
    free(files->at);
    *files = (merlin_sequence_files){.rate = 0};
}
