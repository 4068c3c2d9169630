/* SPDX-License-Identifier: MIT */
/* merlin/sequences: maps of a video's or a sequence's frames that do not flicker.
 *
 *     merlin_sequence *sequence;
 *     merlin_sequence_new(model, NULL, NULL, &sequence);
 *     while (!merlin_frames_next(frames, &frame) && frame.image.data) {
 *         if (merlin_sequence_estimate(sequence, &frame, &maps, NULL)) break;
 *         merlin_maps_write(model, &maps, NULL, folder), merlin_maps_free(&maps);
 *     }
 *     merlin_sequence_write(sequence, merlin_frames_about(frames), "out");
 *     merlin_sequence_free(sequence);
 *
 * From frame to frame exposure and white balance, the crop, the lens, the weights and the light are held or follow
 * slowly; the object without a mask is followed from where it was; and where the picture has not changed, maps are a
 * moving average. What has moved is taken from the frame itself, so that nothing is smeared. */
#ifndef MERLIN_SEQUENCES_H
#define MERLIN_SEQUENCES_H

#include <merlin/estimate.h>
#include <merlin/frames.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { MERLIN_SMOOTH = 8, MERLIN_MOST_SMOOTH = 100 };

/* Options; all zeros are the defaults. */
typedef struct merlin_sequence_params {
    int smooth; /* frames of the moving average, 1 (steady, but without it) to 100; 0: MERLIN_SMOOTH */
    int apart;  /* 1: each frame is estimated by itself, as a photograph; for comparison */
} merlin_sequence_params;

typedef enum merlin_frame_object {
    MERLIN_OBJECT_GIVEN,    /* by a mask */
    MERLIN_OBJECT_FOUND,    /* searched for in all of the frame */
    MERLIN_OBJECT_FOLLOWED, /* found where it was in the frame before */
    MERLIN_OBJECT_LOST,     /* not found again: taken to be where it was expected */
} merlin_frame_object;

/* Facts about how a frame was processed. */
typedef struct merlin_frame_facts {
    long number;
    merlin_frame_object object;
    float overlap;     /* with where it was expected, as intersection over union; 1: given, or the first */
    float exposure[3]; /* factors by which the frame was brightened, by channel */
    int shift[2];      /* how far the object moved, in pixels to the right and down */
    int cut;           /* 1: the frame is of another scene than the one before; nothing was kept */
    float kept;        /* share of the object's pixels at which the moving average went on */
} merlin_frame_facts;

/* Mean differences between successive frames, over the object's pixels that look the same, wherever
 * the object has moved. */
typedef struct merlin_differences {
    double photo;     /* luminance in sRGB's encoding, [0, 1] */
    double albedo;    /* mean of the channels, linear, [0, 1] */
    double normal;    /* degrees */
    double roughness; /* [0, 1] */
    double depth;     /* scene units */
    double mask;      /* coverage, as a share of the object's area */
} merlin_differences;

typedef struct merlin_flicker {
    long pairs;                /* number of pairs of frames with such pixels; 0: nothing could be measured */
    merlin_differences before; /* of what the network made of each frame */
    merlin_differences after;  /* of the maps that were returned */
} merlin_flicker;

typedef struct merlin_sequence merlin_sequence;

/* Begins a sequence. params: as for merlin_estimate, the hint for the first frame; NULL: the defaults. how NULL: the
 * defaults. The model is borrowed. */
merlin_status merlin_sequence_new(merlin_model *model, const merlin_params *params, const merlin_sequence_params *how,
                                  merlin_sequence **out);
/* Makes maps of the next frame, whose image and mask are taken over and empty afterwards, whatever is returned. facts
 * may be NULL. After a failure the sequence cannot go on. */
merlin_status merlin_sequence_estimate(merlin_sequence *sequence, merlin_frame *frame, merlin_maps *maps,
                                       merlin_frame_facts *facts);
/* Leaves the last frame out of what is reported, as its files could not be written. The flicker still has it. */
void merlin_sequence_drop_last(merlin_sequence *sequence);
/* Measures the flicker so far. */
void merlin_sequence_flicker(const merlin_sequence *sequence, merlin_flicker *out);
/* Lists what one should know about the sequence: gaps, cuts, a lost object, an interlaced video, and the doubts of its
 * frames, with their number. head: of its frames, or NULL. */
void merlin_sequence_warnings(const merlin_sequence *sequence, const merlin_frames_head *head, merlin_warnings *out);
/* Composes the text of sequence.json: frames with their facts, flicker, warnings (docs/json.md lists the names).
 * Release it with free. */
merlin_status merlin_sequence_report(const merlin_sequence *sequence, const merlin_frames_head *head, char **text);
/* Writes that file into the folder that holds the frames' folders; the latter are named by merlin_sequence_folder. */
merlin_status merlin_sequence_write(const merlin_sequence *sequence, const merlin_frames_head *head,
                                    const char *folder);
void merlin_sequence_free(merlin_sequence *sequence);

/* Composes the name of a frame's folder of maps, "frame_0001", into text as snprintf does. */
int merlin_sequence_folder(long number, char *text, int size);

/* ---- a sequence's folder ---- */

typedef struct merlin_sequence_file {
    long number;
    char *folder; /* of its maps, joined to the sequence's */
} merlin_sequence_file;

typedef struct merlin_sequence_files {
    double rate;              /* frames a second; 0: unknown */
    merlin_sequence_file *at; /* in order */
    size_t count;
} merlin_sequence_files;

/* Tells whether a folder is a sequence's: 1 or 0. */
int merlin_sequence_is(const char *folder);
/* Reads which frames a sequence has. MERLIN_BAD_INPUT if sequence.json is damaged or a frame's maps are missing. */
merlin_status merlin_sequence_read(const char *folder, merlin_sequence_files *out);
void merlin_sequence_files_free(merlin_sequence_files *files);

#ifdef __cplusplus
}
#endif

#endif
