/* SPDX-License-Identifier: MIT */
/* rti_render FOLDER|FILE.ptm X Y Z OUT.png [relight]: what OpenLIME, or relight's viewer, shows under that light. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../../rti/reader/rti_reader.h"
#include "merlin/image.h"

int main(int argc, char **argv)
{
    if (argc < 6) return 2;
    rti_reader *r = rti_reader_open(argv[1]);
    if (!r) return 1;
    const float direction[3] = {strtof(argv[2], NULL), strtof(argv[3], NULL), strtof(argv[4], NULL)};
    const size_t count = 3 * (size_t)r->width * (size_t)r->height;
    float *values = malloc(count * sizeof *values);
    unsigned char *codes = malloc(count);
    merlin_image out;
    rti_reader_render(r, direction, argc > 6 && strcmp(argv[6], "relight") == 0 ? RTI_RELIGHT : RTI_OPENLIME, values);
    for (size_t i = 0; i < count; i++)
        codes[i] = (unsigned char)(values[i] <= 0 ? 0 : values[i] >= 1 ? 255 : 255 * values[i] + 0.5f);
    const merlin_pixel_layout layout = {.width = r->width, .height = r->height, .channels = 3};
    int failed = merlin_image_from_pixels(codes, &layout, &out, NULL) != MERLIN_OK;
    failed = failed || merlin_image_write(argv[5], &out) != MERLIN_OK;
    if (failed) fprintf(stderr, "%s\n", merlin_error());
    merlin_image_free(&out);
    free(values);
    free(codes);
    rti_reader_close(r);
    return failed;
}
