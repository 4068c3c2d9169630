/* SPDX-License-Identifier: MIT */
/* A reader of relight's folders and of .ptm files that shares nothing with the writers: it goes by what viewers do.
 *
 *     rti_reader *r = rti_reader_open("coin.rti");      NULL: not one, and a line on standard error says why
 *     rti_reader_render(r, (float[3]){0, 0, 1}, RTI_OPENLIME, values);
 *     rti_reader_close(r);
 */
#ifndef MERLIN_TESTS_RTI_READER_H
#define MERLIN_TESTS_RTI_READER_H

/* Whose interpolation between pictures: OpenLIME's goes by how near the lights are, relight's by the file's sigma. */
typedef enum rti_viewer { RTI_OPENLIME, RTI_RELIGHT } rti_viewer;

typedef struct rti_reader {
    int width, height, planes;
    float *values;               /* height × width × planes, as in the formulas, rows from the top */
    float *basis, *lights;       /* of rbf: planes + 1 vectors of `count` × 3 values, and each light's direction */
    int count;                   /* of the lights */
    double sigma;                /* of rbf */
    char type[8], colorspace[8]; /* as in info.json */
} rti_reader;

rti_reader *rti_reader_open(const char *path);
/* Computes the picture, height × width × 3 values that are encoded as sRGB, not clamped. */
void rti_reader_render(const rti_reader *r, const float direction[3], rti_viewer viewer, float *values);
void rti_reader_close(rti_reader *r);

#endif
