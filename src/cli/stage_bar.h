/* A progress bar for each stage of long work, on standard error; none for what is soon done.
 *
 *     stage_bar bar = {.quiet = quiet};
 *     watch w = {stage_bar_tell, &bar};
 *     ... work that is given &w ...
 *     stage_bar_end(&bar); */
#ifndef MERLIN_CLI_STAGE_BAR_H
#define MERLIN_CLI_STAGE_BAR_H

#include "base/progress.h"
#include "base/watch.h"

typedef struct stage_bar {
    progress bar; /* in hundredths of the stage */
    bool quiet;
} stage_bar;

void stage_bar_tell(void *bar, const char *stage, double share);
void stage_bar_end(stage_bar *b);

#endif
