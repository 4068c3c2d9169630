/* SPDX-License-Identifier: MIT */
/* maps_differ A B: how the maps of two folders of one photograph differ, a line each: its name, and the mean and the
 * largest difference of its values where both have the object. */
#include <math.h>
#include <stdbool.h>
#include <stdio.h>

#include "merlin/maps.h"

static void print_difference(const char *name, const merlin_image *a, const merlin_image *b, const merlin_maps *one,
                             const merlin_maps *other)
{
    double sum = 0, most = 0;
    size_t count = 0;
    const size_t pixels = (size_t)a->width * (size_t)a->height, channels = (size_t)a->channels;
    for (size_t i = 0; i < pixels * channels; i++) {
        const size_t pixel = i / channels;
        if (one->mask.data[pixel] <= 0 || other->mask.data[pixel] <= 0) continue;
        const double difference = fabs((double)a->data[i] - (double)b->data[i]);
        sum += difference;
        most = difference > most ? difference : most;
        count++;
    }
    printf("%s %.6f %.6f\n", name, count > 0 ? sum / (double)count : NAN, most);
}

static void print_differences(const merlin_maps *a, const merlin_maps *b)
{
    print_difference("mask", &a->mask, &b->mask, a, b);
    print_difference("albedo", &a->albedo, &b->albedo, a, b);
    print_difference("normal", &a->normal, &b->normal, a, b);
    print_difference("roughness", &a->roughness, &b->roughness, a, b);
    print_difference("depth", &a->depth, &b->depth, a, b);
}

int main(int argc, char **argv)
{
    merlin_maps a = {0}, b = {0};
    const bool read = argc == 3 && merlin_maps_read(argv[1], &a) == MERLIN_OK &&
                      merlin_maps_read(argv[2], &b) == MERLIN_OK && a.mask.width == b.mask.width &&
                      a.mask.height == b.mask.height;
    if (read)
        print_differences(&a, &b);
    else
        fprintf(stderr, "maps_differ: two folders of maps of one size are wanted (%s)\n", merlin_error());
    merlin_maps_free(&a);
    merlin_maps_free(&b);
    return !read;
}
