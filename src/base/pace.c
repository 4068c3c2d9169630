/* SPDX-License-Identifier: MIT */
#include "base/pace.h"

#include <math.h>

/* The share of the work after which what was before weighs a third: costs are planned roughly, and a stage that is
 * quicker than planned must not promise the same of the next. */
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
