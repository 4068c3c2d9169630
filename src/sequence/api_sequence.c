/* SPDX-License-Identifier: MIT */
/* Maps of frames, one after the other (merlin/sequences.h). */
#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/api_needs.h"
#include "estimate/photo/estimate.h"
#include "estimate/surface/exposure.h"
#include "image/formats/img_format.h"
#include "sequence/sequence.h"
#include "sequence/sequence_exposure.h"
#include "sequence/sequence_object.h"

/* Median difference of encoded pictures from which on a frame is of another scene, and factor of its brightness. */
static const float CUT_DIFFERENCE = 0.15f, CUT_BRIGHTNESS = 4;

/* ---- one frame ---- */

typedef struct step {
    merlin_sequence *q;
    merlin_frame *frame;
    merlin_frame_facts facts;
    img seen, same; /* the frame, encoded and exposed; where it is as before, without data: nowhere */
    merlin_object object;
    float confidence;
} step;

static void step_free(step *w)
{
    img_free(&w->seen);
    img_free(&w->same);
    merlin_object_free(&w->object);
    merlin_frame_free(w->frame);
}

static void forget(merlin_sequence *q)
{
    sequence_history_free(&q->history);
    q->crop = (sequence_crop){.begun = false};
    q->shift = (sequence_shift){0, 0};
    q->gain = 0;
    *q->network = 0;
    q->begun = false;
}

/* Finds how far the object moved, and moves what is known of it there. */
static status align(step *w)
{
    merlin_sequence *q = w->q;
    img before = {0}, now = {0};
    const float brightness = sequence_brightness(&q->history.seen, &w->seen, &q->history.mask, q->shift);
    if (brightness > CUT_BRIGHTNESS || brightness < 1 / CUT_BRIGHTNESS) {
        w->facts.cut = 1;
        return OK;
    }
    status s = sequence_grey(&q->history.seen, 1, &before);
    if (s == OK) s = sequence_grey(&w->seen, brightness, &now);
    if (s == OK) s = sequence_align(&before, &now, &q->history.mask, q->shift, &q->shift);
    img_free(&before);
    img_free(&now);
    return s == OK ? sequence_history_move(&q->history, q->shift) : s;
}

/* Finds the factors that bring the frame's exposure and white balance to those of before, of which some share follows
 * the frame's own. */
static void find_exposure(step *w, float factor[3])
{
    const merlin_sequence *q = w->q;
    sequence_factors(&q->history.seen, &w->seen, &q->history.mask, factor);
    for (int c = 0; c < 3 && q->smooth > 1 && !q->apart; c++)
        factor[c] = powf(factor[c], 1 - 0.5f / (float)q->smooth);
    sequence_scale(&w->seen, factor);
}

/* Compares the frame with those before, and exposes it as they are. */
static status compare(step *w)
{
    merlin_sequence *q = w->q;
    float difference = 0, factor[3] = {1, 1, 1};
    status s = align(w);
    if (s == OK && !w->facts.cut) {
        find_exposure(w, factor);
        s = sequence_sameness(&q->history, &w->seen, &w->same, &difference);
    }
    if (s != OK) return s;
    w->facts.cut |= difference > CUT_DIFFERENCE;
    if (w->facts.cut || q->apart) return OK;
    sequence_expose(&w->frame->image, factor);
    memcpy(w->facts.exposure, factor, sizeof factor);
    return OK;
}

static status encode(step *w)
{
    const float unit = w->q->begun ? w->q->history.unit : 1, units[3] = {unit, unit, unit};
    img_free(&w->seen);
    status s = sequence_encode(&w->frame->image, &w->seen);
    if (s == OK) sequence_scale(&w->seen, units);
    return s;
}

/* Encodes the frame, and compares it with those before, which are forgotten at a cut. */
static status look(step *w)
{
    merlin_sequence *q = w->q;
    for (int c = 0; c < 3; c++)
        w->facts.exposure[c] = 1;
    status s = flicker_meter_begin(&q->meter, w->frame->image.width, w->frame->image.height);
    if (s == OK) flicker_meter_take_photo(&q->meter, &w->frame->image, false);
    if (s == OK) s = encode(w);
    if (s == OK && q->begun) s = compare(w);
    if (s == OK && w->facts.cut) {
        img_free(&w->same);
        forget(q);
        s = encode(w);
    }
    if (s != OK) return s;
    flicker_meter_take_photo(&q->meter, &w->frame->image, true);
    w->facts.shift[0] = q->shift.x;
    w->facts.shift[1] = q->shift.y;
    return OK;
}

static status find(step *w)
{
    merlin_sequence *q = w->q;
    const bool follows = q->begun && !q->apart;
    const object_request r = {.photo = &w->frame->image,
                              .mask = &w->frame->mask,
                              .hint = q->count == 0 ? &q->params.hint : NULL,
                              .before = follows ? &q->history.mask : NULL,
                              .was_given = q->was_given};
    status s = sequence_object(&r, &q->confidence, &w->object, &w->facts);
    if (s != OK) return s;
    if (w->facts.object == MERLIN_OBJECT_GIVEN) q->was_given = true;
    return q->apart ? OK : sequence_crop_next(&q->crop, &w->object.mask, q->shift, 1 / (float)q->smooth);
}

/* Reads how the first frame was taken, if it is a picture's file. */
static void find_shot(merlin_sequence *q, const char *path)
{
    merlin_shot shot;
    if (!path || !img_format_of(path).is_read || merlin_shot_read(path, &shot) != OK) return;
    q->params.shot = shot;
    q->params.hint.reduced = shot.reduced;
}

static status estimate(step *w, merlin_maps *maps)
{
    merlin_sequence *q = w->q;
    const estimate_held held = {.crop = q->crop.held,
                                .model = *q->network ? q->network : NULL,
                                .gain = q->gain,
                                .new_share = 0.5f / (float)q->smooth};
    status s = estimate_with_held(q->model, &w->frame->image, &w->object, &q->params, q->apart ? NULL : &held, maps);
    if (s != OK) return s;
    q->gain = maps->gain;
    snprintf(q->network, sizeof q->network, "%s", maps->model);
    flicker_meter_take_maps(&q->meter, maps, false);
    return OK;
}

/* Brings the picture to the unit of the history, which the first frame's gain sets. */
static void set_unit(step *w, const merlin_maps *maps)
{
    const float unit = maps->gain / EXPOSURE_WHITE, units[3] = {unit, unit, unit};
    w->q->history.unit = unit;
    sequence_scale(&w->seen, units);
}

/* Lets the light follow slowly. */
static void blend_light(merlin_found_light *average, float share, bool begun, merlin_found_light *now)
{
    if (begun && now->known && average->known) {
        const float *old = &average->flash;
        float *value = &now->flash;
        const size_t count = (sizeof *now - offsetof(merlin_found_light, flash)) / sizeof(float);
        for (size_t i = 0; i < count; i++)
            value[i] = old[i] + share * (value[i] - old[i]);
        const float *v = now->lamp, length = sqrtf(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
        for (int c = 0; c < 3 && length > 0; c++)
            now->lamp[c] /= length;
    }
    *average = *now;
}

static status blend(step *w, merlin_maps *maps)
{
    merlin_sequence *q = w->q;
    const int most = q->apart ? 1 : q->smooth;
    const bool keep_mask = w->facts.object == MERLIN_OBJECT_GIVEN;
    if (!q->begun) set_unit(w, maps);
    if (!q->apart) blend_light(&q->history.light, 1 / (float)q->smooth, q->begun, &maps->light);
    const bool averages = q->begun && most > 1;
    status s = sequence_blend(&q->history, &w->seen, averages ? &w->same : NULL, most, keep_mask, maps, &w->facts.kept);
    if (s != OK) return s;
    flicker_meter_take_maps(&q->meter, maps, true);
    flicker_meter_end(&q->meter, q->begun ? &w->same : NULL, w->facts.shift);
    q->begun = true;
    return OK;
}

/* ---- what is kept for the report ---- */

static status note(merlin_sequence *q, const step *w, const merlin_maps *maps)
{
    sequence_frame *larger = realloc(q->frames, (q->count + 1) * sizeof *larger);
    if (!larger) return fail(MERLIN_NO_MEMORY, "no memory for one more frame");
    q->frames = larger;
    larger[q->count++] = (sequence_frame){.facts = w->facts,
                                          .crop = {maps->crop.x, maps->crop.y, maps->crop.side},
                                          .gain = maps->gain,
                                          .confidence = maps->mask_confidence};
    q->last_doubts = maps->doubts;
    for (int i = 0; i < SEQUENCE_DOUBTS; i++) {
        const unsigned doubt = 1u << i;
        if (!(maps->doubts & doubt)) continue;
        if (q->doubts[i].frames++ == 0)
            merlin_doubt_message(maps, (merlin_doubt)doubt, q->doubts[i].message, sizeof q->doubts[i].message);
    }
    return OK;
}

/* ---- the public functions ---- */

static status take_frame(step *w, merlin_maps *maps)
{
    merlin_sequence *q = w->q;
    if (q->count == 0) find_shot(q, w->frame->path);
    status s = look(w);
    if (s == OK) s = find(w);
    if (s == OK) s = estimate(w, maps);
    if (s == OK) s = blend(w, maps);
    return s == OK ? note(q, w, maps) : s;
}

merlin_status merlin_sequence_estimate(merlin_sequence *sequence, merlin_frame *frame, merlin_maps *maps,
                                       merlin_frame_facts *facts)
{
    if (maps) *maps = (merlin_maps){0};
    status s = api_needs(__func__, sequence && frame && maps);
    if (s == OK && (!frame->image.data || frame->image.channels != 3))
        s = fail(MERLIN_WRONG_USE, "a frame has 3 channels, and there is none after the last");
    if (s == OK && sequence->begun &&
        (frame->image.width != sequence->meter.width || frame->image.height != sequence->meter.height))
        s = fail(MERLIN_BAD_INPUT,
                 "frame %ld is %d×%d pixels, those before %d×%d; the frames of a sequence have one size", frame->number,
                 frame->image.width, frame->image.height, sequence->meter.width, sequence->meter.height);
    if (s != OK) {
        merlin_frame_free(frame);
        return s;
    }
    step w = {.q = sequence, .frame = frame, .facts = {.number = frame->number}};
    s = take_frame(&w, maps);
    if (facts) *facts = w.facts;
    step_free(&w);
    if (s != OK) merlin_maps_free(maps);
    return s;
}

merlin_status merlin_sequence_new(merlin_model *model, const merlin_params *params, const merlin_sequence_params *how,
                                  merlin_sequence **out)
{
    if (out) *out = NULL;
    status s = api_needs(__func__, model && out);
    if (s == OK && how && (how->smooth < 0 || how->smooth > MERLIN_MOST_SMOOTH))
        s = fail(MERLIN_WRONG_USE, "a moving average is of 1 to %d frames, not %d", MERLIN_MOST_SMOOTH, how->smooth);
    if (s != OK) return s;
    merlin_sequence *q = calloc(1, sizeof *q);
    if (!q) return fail(MERLIN_NO_MEMORY, "no memory for a sequence");
    q->model = model;
    q->params = params ? *params : merlin_params_default();
    q->params.last = 0; /* another frame may follow */
    q->smooth = how && how->smooth ? how->smooth : MERLIN_SMOOTH;
    q->apart = how && how->apart;
    *out = q;
    return OK;
}

void merlin_sequence_drop_last(merlin_sequence *sequence)
{
    if (!sequence || sequence->count == 0) return;
    sequence->count--;
    for (int i = 0; i < SEQUENCE_DOUBTS; i++)
        sequence->doubts[i].frames -= (sequence->last_doubts >> i) & 1;
    sequence->last_doubts = 0;
}

void merlin_sequence_flicker(const merlin_sequence *sequence, merlin_flicker *out)
{
    if (out) *out = (merlin_flicker){.pairs = 0};
    if (sequence && out) flicker_meter_read(&sequence->meter, out);
}

void merlin_sequence_free(merlin_sequence *sequence)
{
    if (!sequence) return;
    sequence_history_free(&sequence->history);
    flicker_meter_free(&sequence->meter);
    free(sequence->frames);
    free(sequence);
}
