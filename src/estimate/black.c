#include "estimate/black.h"

#include <math.h>

void relit_black_level(img *relit)
{
    size_t count = (size_t)relit->width * (size_t)relit->height * (size_t)relit->channels;
    for (size_t i = 0; i < count; i++)
        relit->data[i] = fmaxf(0, (relit->data[i] - RELIT_BLACK) / (1 - RELIT_BLACK));
}
