/* SPDX-License-Identifier: MIT */
#include "cli/expect.h"

#include <stdlib.h>
#include <sys/stat.h>

#include "base/file.h"

static const double MILLION = 1e6;
/* Seconds for any photograph, and for each million pixels. */
static const double FIXED = 0.4, BY_MILLION = 0.3;

static double bytes_of(const char *path)
{
    struct stat about;
    return path && stat(path, &about) == 0 ? (double)about.st_size : 0;
}

/* Estimates from the file's size: a JPEG has less than half a byte per pixel, a PNG two; maps.exr two or three. */
double expect_pixels(const char *path)
{
    if (!file_is_folder(path)) return bytes_of(path);
    char *maps = file_join(path, "maps.exr");
    double bytes = bytes_of(maps);
    free(maps);
    return bytes / 2.5;
}

double expect_photo(const char *path)
{
    return FIXED + BY_MILLION * expect_pixels(path) / MILLION;
}

size_t expect_estimate(double pixels, stage_cost *stages, size_t count)
{
    double millions = pixels / MILLION;
    stages[count++] = (stage_cost){"reading", 0.2 + 0.03 * millions};
    stages[count++] = (stage_cost){"estimating", 0.6 + 0.02 * millions};
    stages[count++] = (stage_cost){"refining", 0.05 + 0.085 * millions};
    return count;
}

size_t expect_maps(double pixels, stage_cost *stages, size_t count)
{
    stages[count++] = (stage_cost){"reading", 0.1 + 0.12 * pixels / MILLION};
    return count;
}

size_t expect_relit(const expect_relight *e, stage_cost *stages, size_t count)
{
    double millions = e->pixels / MILLION, picture = e->environment ? 0.3 + 0.2 * millions : 0.05 + 0.05 * millions;
    stages[count++] = (stage_cost){"preparing", 0.1 + 0.07 * millions};
    stages[count++] = (stage_cost){"relighting", e->pictures * picture};
    stages[count++] = (stage_cost){"going round", e->frames * (e->environment ? 0.35 : 0.05)};
    stages[count++] = (stage_cost){"animating", e->frames * 0.07};
    return count;
}

double expect_maps_written(double pixels, bool mesh)
{
    return 0.1 + (mesh ? 0.24 : 0.17) * pixels / MILLION;
}
