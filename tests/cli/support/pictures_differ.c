/* SPDX-License-Identifier: MIT */
/* pictures_differ A B: how two pictures of an object on black differ, in per cent of the scale from black to white as
 * files have it (sRGB): the mean over the object and its 99th percentile. Of a larger B the upper left part is
 * looked at. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "image/color.h"
#include "merlin/image.h"

static int compare(const void *a, const void *b)
{
    const float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

static const float *pixel(const merlin_image *image, int x, int y)
{
    return image->data + 3 * ((size_t)y * (size_t)image->width + (size_t)x);
}

/* The object is where either is not black. */
static size_t differences(const merlin_image *a, const merlin_image *b, float *out)
{
    size_t count = 0;
    for (int y = 0; y < a->height; y++)
        for (int x = 0; x < a->width; x++) {
            const float *one = pixel(a, x, y), *other = pixel(b, x, y);
            if (!(one[0] + one[1] + one[2] + other[0] + other[1] + other[2] > 0)) continue;
            for (int c = 0; c < 3; c++)
                out[count++] = 100 * fabsf(srgb_encode(one[c]) - srgb_encode(other[c]));
        }
    return count;
}

int main(int argc, char **argv)
{
    merlin_image a = {0}, b = {0};
    if (argc != 3 || merlin_image_read(argv[1], &a, NULL) || merlin_image_read(argv[2], &b, NULL)) {
        fprintf(stderr, "pictures_differ: %s\n", argc == 3 ? merlin_error() : "two pictures wanted");
        return 1;
    }
    float *all =
        b.width >= a.width && b.height >= a.height ? calloc(3 * (size_t)a.width * (size_t)a.height, sizeof *all) : NULL;
    const size_t count = all ? differences(&a, &b, all) : 0;
    double sum = 0;
    for (size_t i = 0; i < count; i++)
        sum += (double)all[i];
    if (count) {
        qsort(all, count, sizeof *all, compare);
        printf("%.4f %.4f\n", sum / (double)count, (double)all[(size_t)(0.99 * (double)(count - 1))]);
    }
    free(all);
    merlin_image_free(&a);
    merlin_image_free(&b);
    return count ? 0 : 1;
}
