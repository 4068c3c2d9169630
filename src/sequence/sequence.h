/* SPDX-License-Identifier: MIT */
/* State of a sequence (merlin/sequences.h), shared by its estimate and its report. */
#ifndef MERLIN_SEQUENCE_SEQUENCE_H
#define MERLIN_SEQUENCE_SEQUENCE_H

#include <stdbool.h>

#include "merlin/sequences.h"
#include "sequence/flicker_meter.h"
#include "sequence/sequence_blend.h"
#include "sequence/sequence_crop.h"

enum { SEQUENCE_DOUBTS = 32 };

/* A frame's facts, and what its maps were made with. */
typedef struct sequence_frame {
    merlin_frame_facts facts;
    crop_square crop;
    float gain, confidence;
} sequence_frame;

/* One doubt: in how many frames there was one, and what it said first. */
typedef struct sequence_doubt {
    long frames;
    char message[MERLIN_WARNING_WORDS];
} sequence_doubt;

struct merlin_sequence {
    merlin_model *model;
    merlin_params params;
    int smooth;
    bool apart;
    bool begun; /* there was a frame, and no cut after it */
    sequence_history history;
    sequence_crop crop;
    sequence_shift shift; /* that of the last frame, expected of the next */
    float gain, confidence;
    char network[64]; /* that chose itself by the first frame */
    bool was_given;   /* the object of the first frame was given by a mask */
    flicker_meter meter;
    sequence_frame *frames;
    size_t count;
    unsigned last_doubts; /* of the last frame */
    sequence_doubt doubts[SEQUENCE_DOUBTS];
};

#endif
