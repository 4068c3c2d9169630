/* SPDX-License-Identifier: MIT */
#include "base/pace.h"

#include <math.h>

/* share of the work after which earlier speed counts a third: the costs of stages are estimates, and a stage that is
 * faster than estimated says little about the next */
static const double MEMORY = 0.5;

void pace_begin(pace *p, double share, double now)
{
    *p = (pace){.share = share, .at = now};
}

void pace_note(pace *p, double share, double now)
{
    double step = share - p->share;
    if (!(step > 0)) return;
    double kept = exp(-step / MEMORY);
    p->done = kept * p->done + step;
    p->seconds = kept * p->seconds + (now - p->at);
    p->share = share;
    p->at = now;
}

double pace_left(const pace *p, double now)
{
    if (!(p->done > 0)) return -1;
    return fmax((1 - p->share) * p->seconds / p->done - (now - p->at), 0);
}
