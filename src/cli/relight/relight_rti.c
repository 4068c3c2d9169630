/* SPDX-License-Identifier: MIT */
#include "cli/relight/relight_rti.h"

#include <string.h>

#include "base/file.h"
#include "cli/relight/relight_parts.h"

static const char *const names[] = {
    [MERLIN_RTI_PTM] = "ptm", [MERLIN_RTI_LRGB] = "lrgb", [MERLIN_RTI_HSH] = "hsh", [MERLIN_RTI_RBF] = "rbf"};
/* Least numbers of pictures, those that merlin_rti_write checks, known before long work. */
static const int fewest[] = {[MERLIN_RTI_PTM] = 6, [MERLIN_RTI_LRGB] = 6, [MERLIN_RTI_HSH] = 9, [MERLIN_RTI_RBF] = 4};

enum { KINDS = sizeof names / sizeof names[0] };

status relight_take_rti(const char *text, void *into)
{
    relight_rti *rti = into;
    for (int i = 0; i < KINDS; i++) {
        if (strcmp(text, names[i]) != 0) continue;
        rti->wanted = true;
        rti->basis = (merlin_rti_basis)i;
        return OK;
    }
    return fail(MERLIN_WRONG_USE, "--rti wants ptm, lrgb, hsh or rbf, not \"%s\"", text);
}

const char *relight_rti_name(const relight_rti *rti)
{
    return names[rti->basis];
}

status relight_rti_check(const relight_rti *rti, int count, bool near, bool other)
{
    const char *name = relight_rti_name(rti);
    if (count == 0) return fail(MERLIN_WRONG_USE, "--rti is made of the pictures of a --dome");
    if (other)
        return fail(MERLIN_WRONG_USE,
                    "--rti writes no pictures: leave out --light, --direction, --lights, --orbit, --lp and --format");
    if (near)
        return fail(MERLIN_WRONG_USE, "--rti is of distant lights, by which viewers relight it: leave out --near");
    if (count < fewest[rti->basis])
        return fail(MERLIN_WRONG_USE, "--rti %s wants a --dome of %d pictures or more, not %d", name,
                    fewest[rti->basis], count);
    if (rti->basis == MERLIN_RTI_RBF && count > MERLIN_RTI_MOST_RBF_PICTURES)
        return fail(MERLIN_WRONG_USE, "--rti rbf wants a --dome of %d pictures or fewer, not %d",
                    MERLIN_RTI_MOST_RBF_PICTURES, count);
    if (rti->file && rti->basis != MERLIN_RTI_PTM && rti->basis != MERLIN_RTI_LRGB)
        return fail(MERLIN_WRONG_USE, "a .ptm file has polynomials: give --rti ptm or lrgb, or name a folder");
    return OK;
}

/* ---- the work ---- */

/* The first picture tells the size. */
static status add(const relight_work *w, const merlin_image *whole, const float direction[3], merlin_rti **rti)
{
    const merlin_rti_params params = {.basis = w->job->rti.basis};
    status s = *rti ? OK : merlin_rti_new(whole->width, whole->height, &params, rti);
    return s == OK ? merlin_rti_add(*rti, whole, direction) : s;
}

static status add_light(relight_work *w, int i, merlin_rti **rti)
{
    const int count = w->job->dome.count;
    const merlin_lamp lamp = relight_dome_lamp(w->job, i);
    merlin_image square = {0}, whole = {0};
    float direction[3];
    merlin_dome_direction(i, count, direction);
    watch_tell(w->job->watch, "relighting", (double)w->done++ / (double)relight_count_whole(w->job));
    status s = relight_check(w);
    if (s == OK) s = relight_square(w, &lamp, 1, &square);
    if (s == OK) s = merlin_relighter_place(w->relighter, &square, &whole);
    if (s == OK) s = add(w, &whole, direction, rti);
    merlin_image_free(&square);
    merlin_image_free(&whole);
    return s;
}

status relight_write_rti(relight_work *w)
{
    const char *file = w->job->rti.file;
    merlin_rti *rti = NULL;
    char path[PATH_MAX];
    status s = OK;
    for (int i = 0; i < w->job->dome.count && s == OK; i++)
        s = add_light(w, i, &rti);
    /* an earlier one may have had more planes */
    if (s == OK && !file && file_is_in(w->job->output, "info.json"))
        s = staging_drop_numbered(w->staging, "plane_", ".jpg");
    if (s == OK)
        s = file ? merlin_rti_write_ptm(rti, staging_path(w->staging, file, path))
                 : merlin_rti_write(rti, staging_folder(w->staging), NULL);
    merlin_rti_free(rti);
    return s;
}
