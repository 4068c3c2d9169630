/* SPDX-License-Identifier: MIT */
#include "lab/eval/metrics/scores.h"

#include <math.h>

#include "lab/eval/metrics/metrics.h"

double eval_score(const eval_scores *scores, eval_row row, eval_answer answer)
{
    size_t count = scores->count[row][answer];
    return count ? scores->sum[row][answer] / (double)count : NAN;
}

double eval_best_trivial(const eval_scores *scores, eval_row row)
{
    double best = NAN;
    for (int answer = EVAL_MEAN; answer <= EVAL_UNCHANGED; answer++) {
        double score = eval_score(scores, row, (eval_answer)answer);
        best = row >= EVAL_RECONSTRUCTION ? fmax(best, score) : fmin(best, score);
    }
    return best;
}

double eval_region_error(const eval_region *region, eval_row map, eval_answer answer)
{
    return region->pixels ? region->sum[map][answer] / (double)region->pixels : NAN;
}

void eval_note(eval_scores *scores, eval_row row, eval_answer answer, double value)
{
    scores->sum[row][answer] += value;
    scores->count[row][answer]++;
}

status eval_note_similarity(eval_scores *scores, eval_row row, eval_answer answer, const img *image, const img *target)
{
    double similarity = 0;
    status s = eval_ssim(image, target, &similarity);
    if (s == OK) eval_note(scores, row, answer, similarity);
    return s;
}

void eval_repeat_trivial(eval_scores *scores, eval_row from, eval_row to)
{
    for (int answer = EVAL_MEAN; answer <= EVAL_UNCHANGED; answer++) {
        scores->sum[to][answer] = scores->sum[from][answer];
        scores->count[to][answer] = scores->count[from][answer];
    }
}
