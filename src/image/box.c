#include <stdlib.h>
#include <string.h>

#include "image/resize.h"

static void box_line(const float *in, float *out, int count, size_t step, int planes, int radius, double *sums)
{
    memset(sums, 0, (size_t)planes * sizeof *sums);
    for (int i = -radius; i < count; i++) {
        int enters = i + radius, leaves = i - radius - 1;
        if (enters < count)
            for (int p = 0; p < planes; p++)
                sums[p] += in[(size_t)enters * step + (size_t)p];
        if (leaves >= 0)
            for (int p = 0; p < planes; p++)
                sums[p] -= in[(size_t)leaves * step + (size_t)p];
        if (i >= 0)
            for (int p = 0; p < planes; p++)
                out[(size_t)i * step + (size_t)p] = (float)sums[p];
    }
}

/* Running sums, in double so that adding and taking away leaves no trace. */
status img_box_sums(img *image, img *scratch, int radius)
{
    int planes = image->channels;
    size_t line = (size_t)image->width * (size_t)planes;
    int failed = 0;
#pragma omp parallel
    {
        double *sums = malloc((size_t)planes * sizeof *sums);
        if (!sums) {
#pragma omp atomic write
            failed = 1;
        }
#pragma omp for schedule(static)
        for (int y = 0; y < image->height; y++)
            if (sums)
                box_line(img_at(image, 0, y), img_at(scratch, 0, y), image->width, (size_t)planes, planes, radius,
                         sums);
#pragma omp for schedule(static)
        for (int x = 0; x < image->width; x++)
            if (sums) box_line(img_at(scratch, x, 0), img_at(image, x, 0), image->height, line, planes, radius, sums);
        free(sums);
    }
    return failed ? fail(ERROR_MEMORY, "no memory to filter an image") : OK;
}
