/* A folder of rendered samples as training sees it: read once, kept packed in memory, unpacked into a batch in any of
 * the eight orientations.
 *
 *     trn_dataset *d;
 *     status s = trn_dataset_open("data/train", 128, 11.0, &d);
 *     trn_view v = ...;                                    where in the batch it goes
 *     if (s == OK) s = trn_dataset_get(d, 17, 0, &v);
 *     trn_dataset_close(d);
 *
 * Samples are files in order of their names. Only what lies inside the object's outline is kept, as the half floats of
 * the file, so that a sample from memory equals one from disk bit for bit. */
#ifndef MERLIN_TRAIN_DATASET_H
#define MERLIN_TRAIN_DATASET_H

#include <stddef.h>

#include "base/status.h"

typedef struct trn_dataset trn_dataset;

/* One sample's places in the batch, each size × size × channels floats, channels last. */
typedef struct trn_view {
    int size;
    float *albedo;    /* 3, [0, 1] until trn_prepare turns it to [-1, 1] */
    float *normal;    /* 3 */
    float *roughness; /* 1, like albedo */
    float *depth;     /* 1 */
    float *mask;      /* 1, coverage until trn_prepare makes it 0 or 1 */
    float *direct;    /* 3 */
    float *indirect;  /* 3 */
    /* filled by trn_prepare */
    float *image, *reconstruction, *relit; /* 3 */
    float *loss_mask;                      /* 1 */
    float *light;                          /* 3 values */
} trn_view;

/* An orientation: the camera, its flash and the frame look the same after each of the square's eight symmetries, so a
 * turned sample is as true as the original. Sum of: */
enum { TRN_FLIP_X = 1, TRN_FLIP_Y = 2, TRN_TRANSPOSE = 4, TRN_ORIENTATIONS = 8 };

/* Refuses an empty folder. size: what every sample's width and height must be. Samples read are kept until they fill
 * memory_gib. */
status trn_dataset_open(const char *folder, int size, double memory_gib, trn_dataset **out);
void trn_dataset_close(trn_dataset *d);
size_t trn_dataset_count(const trn_dataset *d);
/* Everything outside the outline becomes zero. Safe to call from several threads. */
status trn_dataset_get(trn_dataset *d, size_t i, int orientation, const trn_view *out);
/* Of the first sample read; 0 before. */
int trn_dataset_generator_version(const trn_dataset *d);

#endif
