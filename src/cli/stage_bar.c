#include "cli/stage_bar.h"

#include <string.h>

enum { HUNDRED = 100 };

void stage_bar_end(stage_bar *b)
{
    if (b->bar.label && b->bar.shown > b->bar.started) progress_end(&b->bar);
    b->bar = (progress){0};
}

void stage_bar_tell(void *bar, const char *stage, double share)
{
    stage_bar *b = bar;
    if (!b->bar.label || strcmp(b->bar.label, stage) != 0) {
        stage_bar_end(b);
        progress_begin(&b->bar, stage, "%", 0, HUNDRED, b->quiet);
    }
    size_t done = (size_t)(share * HUNDRED);
    progress_update(&b->bar, done < HUNDRED ? done : HUNDRED, NULL);
}
