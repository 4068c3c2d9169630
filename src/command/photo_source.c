/* SPDX-License-Identifier: MIT */
#include "command/photo_source.h"

#include <cjson/cJSON.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "base/file.h"
#include "base/json/json_put.h"

enum { LARGEST_REPORT = 1 << 24 };

static bool put_file(cJSON *to, const char *key, const char *path)
{
    struct stat facts;
    if (stat(path, &facts) != 0) return false;
    cJSON *file = json_put_object(to, key);
    json_put_text(file, "name", file_name_of(path));
    json_put_number(file, "bytes", (double)facts.st_size);
    return true;
}

static void put_hint(cJSON *to, const merlin_hint *hint)
{
    if (hint->box.width > 0) {
        const int box[] = {hint->box.x, hint->box.y, hint->box.width, hint->box.height};
        json_put_item(to, "box", cJSON_CreateIntArray(box, 4));
    }
    cJSON *points = hint->point_count > 0 ? json_put_array(to, "points") : NULL;
    for (int i = 0; i < hint->point_count && points; i++) {
        const int point[] = {hint->point[i].x, hint->point[i].y};
        json_append(points, cJSON_CreateIntArray(point, 2));
    }
}

/* Puts the options that maps depend on. */
static void put_options(cJSON *to, const photo_how *how)
{
    const merlin_params *p = how->params;
    cJSON *options = json_put_object(to, "options");
    json_put_text(options, "model", file_name_of(how->weights));
    if (how->flash_weights) json_put_text(options, "flash_model", file_name_of(how->flash_weights));
    json_put_number(options, "size", p->size);
    json_put_number(options, "views", p->views);
    if (p->fov > 0) json_put_number(options, "fov", (double)p->fov);
    if (p->flash) json_put_bool(options, "flash", true);
    if (!p->auto_exposure) json_put_number(options, "exposure", (double)p->exposure);
    put_hint(options, &p->hint);
}

/* Describes files and options; NULL if a file is not there. */
static cJSON *describe(const photo_job *job, const photo_how *how)
{
    cJSON *source = cJSON_CreateObject();
    const bool there =
        put_file(source, "photograph", job->photo) && (!job->mask || put_file(source, "mask", job->mask));
    if (there) put_options(source, how);
    if (there) return source;
    cJSON_Delete(source);
    return NULL;
}

/* Reads a folder's report; NULL if there is none that can be read. */
static cJSON *read_report(const char *folder, char **path)
{
    char *text = NULL;
    size_t size = 0;
    *path = file_join(folder, "report.json");
    cJSON *report =
        *path && file_read(*path, LARGEST_REPORT, &text, &size) == OK ? cJSON_ParseWithLength(text, size) : NULL;
    free(text);
    return report;
}

status photo_source_note(const photo_job *job, const photo_how *how, const char *folder)
{
    char *path;
    cJSON *report = read_report(folder, &path), *source = describe(job, how);
    status s = OK;
    if (!source) s = fail(MERLIN_BAD_INPUT, "%s, or its mask, is not there any more", job->photo);
    if (s == OK) json_put_item(report, "source", source);
    char *text = s == OK && report ? json_print(report) : NULL;
    if (s == OK && !text) s = fail(MERLIN_NO_MEMORY, "no memory for a report");
    if (s == OK) s = file_write(path, text, strlen(text));
    cJSON_Delete(report);
    free(text);
    free(path);
    return s;
}

bool photo_source_is_noted(const photo_job *job, const photo_how *how, const char *folder)
{
    char *path;
    cJSON *report = read_report(folder, &path), *source = describe(job, how);
    char *noted = json_print_line(cJSON_GetObjectItem(report, "source")), *own = json_print_line(source);
    const bool same = noted && own && strcmp(noted, own) == 0;
    cJSON_Delete(report);
    cJSON_Delete(source);
    free(noted);
    free(own);
    free(path);
    return same;
}
