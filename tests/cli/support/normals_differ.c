/* SPDX-License-Identifier: MIT */
/* Compares the normals of two result folders from outside of the command: normals_differ A B prints the mean angle in
 * degrees over the pixels that both masks hold, in two decimals. Normals are 16-bit, (n + 1)/2. */
#include <stdio.h>

#include "base/vec.h"
#include "image/read/read.h"

typedef struct result {
    img normal, mask;
} result;

static status read_result(const char *folder, result *out)
{
    char path[4096];
    int bits;
    snprintf(path, sizeof path, "%s/normal.png", folder);
    status s = img_read_samples(path, false, &out->normal, &bits);
    if (s != OK) return s;
    snprintf(path, sizeof path, "%s/mask.png", folder);
    return img_read_mask(path, &out->mask);
}

static vec3 normal_of(const result *r, size_t i)
{
    const float *code = r->normal.data + 3 * i;
    return vec3_make(2 * code[0] - 1, 2 * code[1] - 1, 2 * code[2] - 1);
}

static void free_result(result *r)
{
    img_free(&r->normal);
    img_free(&r->mask);
}

/* Prints the mean angle where both have an object; false if that is nowhere. */
static bool print_mean(const result *a, const result *b)
{
    double sum = 0;
    size_t count = 0, pixels = img_value_count(&a->mask);
    for (size_t i = 0; i < pixels; i++) {
        if (a->mask.data[i] < 0.5f || b->mask.data[i] < 0.5f) continue;
        sum += vec3_angle(normal_of(a, i), normal_of(b, i));
        count++;
    }
    if (count > 0)
        printf("%.2f\n", sum / (double)count);
    else
        fprintf(stderr, "normals_differ: the masks have no pixel in common\n");
    return count > 0;
}

int main(int argc, char **argv)
{
    result a = {0}, b = {0};
    bool read = argc == 3 && read_result(argv[1], &a) == OK && read_result(argv[2], &b) == OK &&
                a.normal.width == b.normal.width && a.normal.height == b.normal.height;
    if (!read) fprintf(stderr, "normals_differ: two result folders of one size are wanted (%s)\n", status_message());
    bool done = read && print_mean(&a, &b);
    free_result(&a);
    free_result(&b);
    return !done;
}
