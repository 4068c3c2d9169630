/* SPDX-License-Identifier: MIT */
#include "command/photos.h"

#include <limits.h>
#include <search.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/file.h"
#include "base/json/json_put.h"
#include "command/cli.h"
#include "command/json_line.h"
#include "command/photo_folder.h"
#include "command/photo_hint.h"
#include "command/photo_source.h"
#include "command/standard_input.h"
#include "merlin/estimate.h"

/* ---- names ---- */

/* Returns the length of path without its last ending. */
static size_t stem_length(const char *path)
{
    const char *name = file_name_of(path), *dot = strrchr(name, '.');
    return dot && dot > name ? (size_t)(dot - path) : strlen(path);
}

static char *format_name(const char *path, size_t length, const char *suffix)
{
    char *out = NULL;
    return asprintf(&out, "%.*s%s", (int)length, path, suffix) < 0 ? NULL : out;
}

static char *default_output(const char *photo)
{
    return format_name(photo, stem_length(photo), ".merlin");
}

char *photo_output_inside(const char *input, const char *name, const char *asked)
{
    if (asked) return strdup(asked);
    char *base = file_is_folder(input) ? strdup(input) : default_output(input);
    char *out = base ? file_join(base, name) : NULL;
    free(base);
    return out;
}

const char *photo_without_maps_name(char *input)
{
    char *slash = strrchr(input, '/');
    const char *name = file_name_of(input);
    if ((strcmp(name, "maps.exr") != 0 && strcmp(name, "report.json") != 0) || !file_exists(input)) return input;
    if (!slash) return ".";
    slash[slash == input] = 0;
    return input;
}

status photo_take_input(char **argument, const char *output, const char **input)
{
    status s = standard_input_take(argument);
    if (s != OK) return s;
    *input = photo_without_maps_name(*argument);
    if (output || !standard_input_is(*input)) return OK;
    return fail(MERLIN_WRONG_USE, "a photograph from standard input has no name to go by: say where to by -o");
}

/* ---- the list ---- */

void photo_use_hint(photo_job *job, const merlin_hint *hint)
{
    free(job->mask);
    job->mask = NULL;
    job->hint = hint;
}

static void free_job(photo_job *job)
{
    free(job->photo);
    free(job->output);
    free(job->mask);
}

void photo_list_free(photo_list *list)
{
    for (size_t i = 0; i < list->count; i++)
        free_job(&list->at[i]);
    for (size_t i = 0; i < list->folders; i++) {
        free(list->folder[i].path);
        skipped_free(&list->folder[i].skipped);
    }
    free(list->at);
    free(list->folder);
    *list = (photo_list){0};
}

static status no_memory(void)
{
    return fail(MERLIN_NO_MEMORY, "no memory for file names");
}

static status choose_masks(photo_list *list, const char *mask, bool batch)
{
    if (!mask) return OK;
    if (file_is_folder(mask)) return photo_folder_find_masks(list, mask);
    if (batch) return fail(MERLIN_WRONG_USE, "--mask wants a folder of masks for several photographs, not %s", mask);
    free(list->at[0].mask);
    list->at[0].mask = strdup(mask);
    return list->at[0].mask ? OK : no_memory();
}

/* Tells whether both name one place, however their folder is spelled; the folder exists if the photograph does. */
static bool is_same_place(const char *one, const char *other)
{
    if (strcmp(one, other) == 0) return true;
    if (strcmp(file_name_of(one), file_name_of(other)) != 0) return false;
    char *a = file_folder_of(one), *b = file_folder_of(other);
    bool same = a && b && file_is_same(a, b);
    free(a);
    free(b);
    return same;
}

static int compare_last_names(const void *a, const void *b)
{
    return strcmp(file_name_of(a), file_name_of(b));
}

/* Tells whether a name is taken. names: a search tree, so that lists of hundred thousands of names are fast. */
static bool is_taken(const photo_list *list, void *const *names, size_t before, const char *output)
{
    if (!tfind(output, names, compare_last_names)) return false;
    for (size_t i = 0; i < before; i++)
        if (is_same_place(list->at[i].output, output)) return true;
    return false;
}

/* Chooses a folder name that no earlier photograph of the batch has, as there may be cup.png and cup.jpg. */
static status choose_output(photo_list *list, void **names, size_t i, const char *folder)
{
    photo_job *job = &list->at[i];
    for (int number = 1; number < 10000; number++) {
        const char *ending = folder ? "" : ".merlin";
        char suffix[32], *name = NULL;
        if (number > 1)
            snprintf(suffix, sizeof suffix, "-%d%s", number, ending);
        else
            snprintf(suffix, sizeof suffix, "%s", ending);
        if (folder) {
            const char *photo = file_name_of(job->photo);
            char *last = format_name(photo, stem_length(photo), suffix);
            name = last ? file_join(folder, last) : NULL;
            free(last);
        } else {
            name = format_name(job->photo, stem_length(job->photo), suffix);
        }
        if (!name) return no_memory();
        if (!is_taken(list, names, i, name)) {
            job->output = name;
            return tsearch(name, names, compare_last_names) ? OK : no_memory();
        }
        free(name);
    }
    return fail(MERLIN_WRONG_USE, "too many photographs are called %s", job->photo);
}

static void keep(void *name)
{
    (void)name; /* belongs to the list */
}

static status choose_outputs(photo_list *list, const char *folder)
{
    void *names = NULL;
    status s = OK;
    for (size_t i = 0; i < list->count && s == OK; i++)
        s = choose_output(list, &names, i, folder);
    tdestroy(names, keep);
    return s;
}

/* Adds a photograph; without a requested mask its own is used. */
static status add_photo(photo_list *list, const char *photo, const char *mask)
{
    status s = photo_list_add(list, photo);
    return s == OK && !mask ? photo_own_mask(photo, &list->at[list->count - 1].mask) : s;
}

static status fill_list(char *const *arguments, int count, const char *mask, const char *output, photo_list *out)
{
    bool batch = count > 1;
    status s = OK;
    for (int i = 0; i < count && s == OK; i++) {
        bool folder = file_is_folder(arguments[i]);
        batch |= folder;
        s = folder ? photo_folder_add(out, arguments[i], mask) : add_photo(out, arguments[i], mask);
    }
    if (s == OK && count > 1 && !mask) photo_list_drop_masks(out);
    if (s == OK && out->count == 0)
        s = fail(MERLIN_BAD_INPUT, "no photographs, but maps that were made of one in the folder %s", arguments[0]);
    if (s == OK) s = choose_masks(out, mask, batch);
    if (s != OK) return s;
    if (!batch && output) {
        out->at[0].output = strdup(output);
        return out->at[0].output ? OK : no_memory();
    }
    return choose_outputs(out, output);
}

status photo_list_make(char *const *arguments, int count, const char *mask, const char *output, photo_list *out)
{
    *out = (photo_list){0};
    status s = fill_list(arguments, count, mask, output, out);
    if (s != OK) photo_list_free(out);
    return s;
}

/* Removes photographs that are not kept, by their index. */
static void keep_those(photo_list *list, bool (*kept)(const photo_job *job, size_t i, const void *context),
                       const void *context)
{
    size_t count = 0;
    for (size_t i = 0; i < list->count; i++)
        if (kept(&list->at[i], i, context))
            list->at[count++] = list->at[i];
        else
            free_job(&list->at[i]);
    list->count = count;
}

static bool is_of_share(const photo_job *job, size_t i, const void *context)
{
    const photo_share *share = context;
    (void)job;
    return i % share->of == share->which - 1;
}

void photo_list_share(photo_list *list, const photo_share *share)
{
    keep_those(list, is_of_share, share);
}

/* Tells whether a file is missing, or older than what it was made of, as make does. */
static bool is_older(const char *path, const photo_job *job)
{
    struct stat own, photo, mask;
    if (!path || stat(path, &own) != 0 || stat(job->photo, &photo) != 0 || photo.st_mtime > own.st_mtime) return true;
    return job->mask && (stat(job->mask, &mask) != 0 || mask.st_mtime > own.st_mtime);
}

/* Tells whether a photograph has no maps, those of another one, older or otherwise made ones, or not all files that
 * are wanted. */
static bool is_to_do(const photo_job *job, size_t i, const void *context)
{
    const photo_wanted *wanted = context;
    bool old = !photo_source_is_noted(job, &wanted->how, job->output);
    (void)i;
    for (const char *const *name = wanted->inside; *name && !old; name++) {
        char *path = file_join(job->output, *name);
        old = is_older(path, job);
        free(path);
    }
    for (size_t k = 0; k < wanted->count && !old; k++)
        old = is_older(wanted->elsewhere[k], job);
    return old;
}

size_t photo_list_drop_done(photo_list *list, const photo_wanted *wanted)
{
    size_t before = list->count;
    keep_those(list, is_to_do, wanted);
    return before - list->count;
}

void photo_list_tell(const photo_list *list, const char *command)
{
    for (size_t i = 0; i < list->folders; i++)
        skipped_print(&list->folder[i].skipped, command, list->folder[i].path);
}

void photo_list_put(const photo_list *list, cJSON *report)
{
    warnings told = {0};
    cJSON *all = NULL;
    for (size_t i = 0; i < list->folders; i++) {
        if (list->folder[i].skipped.count && !all) all = json_put_array(report, "skipped");
        skipped_warn(&list->folder[i].skipped, &told);
        skipped_json(&list->folder[i].skipped, list->folder[i].path, all);
    }
    for (size_t i = 0; i < told.count; i++) {
        cJSON *one = json_append_object(cJSON_GetObjectItem(report, "warnings"));
        json_put_text(one, "code", told.at[i].code);
        json_put_text(one, "message", told.at[i].message);
    }
}

/* ---- options ---- */

status photo_take_share(const char *text, void *into)
{
    photo_share *share = into;
    int used = 0;
    if (sscanf(text, "%zu/%zu%n", &share->which, &share->of, &used) == 2 && !text[used] && !strchr(text, '-') &&
        share->which >= 1 && share->which <= share->of)
        return OK;
    return fail(MERLIN_WRONG_USE, "--share wants K/N, the K-th of N shares, such as 1/4, not '%s'", text);
}

/* Finds NAME.safetensors among the program's own weights; *path is NULL if there is none. */
static status find_shipped(const char *name, char **path)
{
    static const char *const places[] = {"models", "../models", "../../models", "../share/merlin/models",
                                         "../../../share/merlin/models"};
    char folder[PATH_MAX];
    *path = NULL;
    if (!file_program_folder(folder)) return OK;
    for (size_t i = 0; i < sizeof places / sizeof places[0]; i++) {
        if (asprintf(path, "%s/%s/%s.safetensors", folder, places[i], name) < 0) return no_memory();
        if (file_exists(*path)) return OK;
        free(*path);
        *path = NULL;
    }
    return OK;
}

status photo_find_model(const char *asked, char **path)
{
    const char *environment = getenv("MERLIN_MODEL"), *by = "";
    if (!asked && environment && *environment) {
        asked = environment;
        by = "MERLIN_MODEL: ";
        if (strchr(asked, '/') && !file_exists(asked))
            return fail(MERLIN_BAD_INPUT, "%sthere is no weights file %s", by, asked);
    }
    /* a folder of merlin-env's results may have this name */
    bool is_file =
        asked && (strchr(asked, '/') || strchr(asked, '.') || (file_exists(asked) && !file_is_folder(asked)));
    if (is_file) return (*path = strdup(asked)) ? OK : no_memory();
    status s = find_shipped(asked ? asked : "merlin-point", path);
    if (s != OK || *path) return s;
    if (asked)
        return fail(MERLIN_BAD_INPUT, "%sthere is no weights file %s, nor are weights of that name with merlin", by,
                    asked);
    return fail(MERLIN_BAD_INPUT,
                "no models/merlin-point.safetensors near the program: give --model or set MERLIN_MODEL");
}

/* Tells whether the user chose the weights. */
static bool is_chosen(const char *asked)
{
    const char *environment = getenv("MERLIN_MODEL");
    return asked || (environment && *environment);
}

status photo_find_models(const char *asked, char **path, char **flash)
{
    *path = *flash = NULL;
    if (is_chosen(asked)) return photo_find_model(asked, path);
    status s = find_shipped("merlin-any", path);
    if (s == OK && !*path) return photo_find_model(NULL, path);
    return s == OK ? find_shipped("merlin-point", flash) : s;
}

status photo_find_models_of(const merlin_maps *maps, const char *asked, char **path, char **flash)
{
    *path = *flash = NULL;
    const bool of_pair = strcmp(maps->model, "merlin-any") == 0 || strcmp(maps->model, "merlin-point") == 0;
    const bool is_name = !maps->captured && !of_pair && !strchr(maps->model, '/');
    status s = is_name && !is_chosen(asked) ? find_shipped(maps->model, path) : OK;
    return s == OK && !*path ? photo_find_models(asked, path, flash) : s;
}

status photo_find_several(const char *asked, char **path)
{
    *path = NULL;
    return asked ? photo_find_model(asked, path) : find_shipped("merlin-several", path);
}

status photo_open_near(const char *asked, bool needed, merlin_near_network **out)
{
    char *path = NULL;
    *out = NULL;
    status s = asked ? photo_find_model(asked, &path) : find_shipped("merlin-nfps", &path);
    if (s == OK && path) s = merlin_near_network_open(path, out);
    if (s == OK && !path && needed)
        s = fail(MERLIN_BAD_INPUT, "method nfps: no models/merlin-nfps.safetensors near the program: give --model");
    free(path);
    return s;
}

status photo_add_several(const char *flash, merlin_model *model)
{
    char *several = NULL;
    status s = flash ? photo_find_several(NULL, &several) : OK;
    if (s == OK && several) s = merlin_model_add_several(model, several);
    free(several);
    return s;
}

status photo_open_models(const char *path, const char *flash, merlin_model **out)
{
    status s = merlin_model_open(path, out);
    if (s == OK && flash) s = merlin_model_add_flash(*out, flash);
    if (s == OK) return OK;
    merlin_model_close(*out);
    *out = NULL;
    return s;
}

status photo_take_size(const char *text, void *into)
{
    merlin_params *params = into;
    long size;
    status s = cli_int("--size", text, MERLIN_LEAST_SIZE, MERLIN_LARGEST_SIZE, &size);
    if (s == OK && size % MERLIN_SIZE_STEP != 0)
        s = fail(MERLIN_WRONG_USE, "--size must be a multiple of %d, not %ld", MERLIN_SIZE_STEP, size);
    if (s == OK) params->size = (int)size;
    return s;
}

status photo_take_exposure(const char *text, void *into)
{
    merlin_params *params = into;
    double ev = 0;
    params->auto_exposure = strcmp(text, "auto") == 0;
    status s = params->auto_exposure ? OK : cli_float("--exposure", text, -20, 20, &ev);
    params->exposure = (float)ev;
    return s;
}

bool photo_params_given(const merlin_params *params)
{
    merlin_params usual = merlin_params_default();
    return params->size != usual.size || params->views != usual.views || params->auto_exposure != usual.auto_exposure ||
           photo_hint_given(&params->hint);
}

status photo_check_maps(const char *folder, const char *mask, const merlin_params *params)
{
    if (!mask && !photo_params_given(params)) return OK;
    return fail(MERLIN_WRONG_USE,
                "--mask, --point, --box, --size, --views and --exposure are for a photograph; %s holds maps already",
                folder);
}
