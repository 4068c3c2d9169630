/* SPDX-License-Identifier: MIT */
/* A dome: pictures under lights spread evenly over the frontal hemisphere, for RTI tools and for merlin stereo. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/lights/light_list.h"
#include "cli/check_replaced.h"
#include "cli/relight/relight_parts.h"

merlin_lamp relight_dome_lamp(const relight_job *job, int i)
{
    return lamp_in_style(merlin_dome_lamp(i, job->dome.count, job->dome.near), &job->lamps.common);
}

/* ---- lists ---- */

/* Prints the directions to distant lights, the only ones that an .lp file can contain. */
static void print_lp(FILE *f, const void *context)
{
    const relight_job *job = context;
    fprintf(f, "%d\n", job->dome.count);
    for (int i = 0; i < job->dome.count; i++) {
        float d[3];
        merlin_dome_direction(i, job->dome.count, d);
        fprintf(f, "dome_%03d%s %.6f %.6f %.6f\n", i, relight_ending(job), (double)d[0], (double)d[1], (double)d[2]);
    }
}

static void print_places(FILE *f, const void *context)
{
    const relight_job *job = context;
    fprintf(f, LIST_OF_PLACES "%s and on, x y z from the camera: for merlin stereo --near --fov %.2f\n",
            relight_ending(job), merlin_maps_field_of_view(job->maps));
    for (int i = 0; i < job->dome.count; i++) {
        const merlin_lamp l = relight_dome_lamp(job, i);
        float place[3];
        merlin_maps_lens_place(job->maps, l.at, place);
        fprintf(f, "%.6f %.6f %.6f\n", (double)place[0], (double)place[1], (double)place[2]);
    }
}

/* ---- an earlier dome in the same folder ---- */

/* Finds an earlier dome's list, whose lights would be assigned to these pictures of the same names. */
static status look_for_directions(const char *folder, bool *has)
{
    char *path = file_join(folder, "dome.lp");
    light_list list = {0};
    status s = !path               ? fail(MERLIN_NO_MEMORY, "no memory for a file name")
               : file_exists(path) ? light_list_read(path, &list)
                                   : OK;
    *has = s == OK && list.name && strncmp(list.name[0], "dome_000.", 9) == 0;
    light_list_free(&list);
    free(path);
    return s == MERLIN_NO_MEMORY ? s : OK;
}

/* Tells whether a file is a picture of an earlier dome that this one does not replace. */
static bool is_left_over(const relight_job *job, const char *name)
{
    if (!relight_is_numbered(name, "dome_")) return false;
    return strcmp(name + 8, relight_ending(job)) != 0 || atoi(name + 5) >= job->dome.count;
}

static status refuse(const relight_job *job, const char *name)
{
    return fail(MERLIN_CANNOT_WRITE,
                "%s/%s is of another dome and would be taken with this one's pictures: choose another folder, or "
                "remove it",
                job->output, name);
}

status relight_dome_check(const relight_job *job)
{
    static const char *const endings[] = {".png", ".jpg", NULL};
    char **names;
    size_t count;
    if (!file_is_folder(job->output)) return OK;
    status s = file_list(job->output, endings, &names, &count);
    if (s != OK) return s;
    for (size_t i = 0; i < count && s == OK; i++)
        if (is_left_over(job, file_name_of(names[i]))) s = refuse(job, file_name_of(names[i]));
    file_list_free(names, count);
    bool has = false;
    if (s == OK && job->dome.near > 0) s = look_for_directions(job->output, &has);
    if (s == OK && has) s = refuse(job, "dome.lp");
    if (s == OK && job->dome.near > 0) s = check_list_replaced(job->output);
    if (s == OK && job->dome.near == 0 && list_begins_with(job->output, LIST_OF_PLACES)) s = refuse(job, "lights.txt");
    return s;
}

/* ---- the whole ---- */

static status write_lists(const relight_work *w)
{
    const relight_job *job = w->job;
    char path[PATH_MAX];
    if (job->dome.near > 0) return file_print(staging_path(w->staging, "lights.txt", path), print_places, job);
    bool has = job->dome.lp;
    status s = has ? OK : look_for_directions(job->output, &has);
    if (s != OK || !has) return s;
    return file_print(staging_path(w->staging, "dome.lp", path), print_lp, job);
}

/* Writes the mask as WebP, which RTI tools do not take for a picture under a light, and merlin stereo recognizes as the
 * mask. */
static status write_mask(const relight_work *w)
{
    char path[PATH_MAX];
    return merlin_mask_write(&w->job->maps->mask, staging_path(w->staging, "mask.webp", path));
}

status relight_write_dome(relight_work *w)
{
    status s = OK;
    for (int i = 0; i < w->job->dome.count && s == OK; i++) {
        const merlin_lamp light = relight_dome_lamp(w->job, i);
        s = relight_check(w);
        if (s == OK) s = relight_write(w, &(relight_picture){"dome", (size_t)i, &light, 1, NULL, false});
    }
    if (s == OK) s = write_mask(w);
    return s == OK ? write_lists(w) : s;
}
