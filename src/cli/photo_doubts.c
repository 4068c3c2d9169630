#include "cli/photo_doubts.h"

#include <stdio.h>

/* merlin.h says what they mean. */
static const float LITTLE_CONFIDENCE = 0.6f, MUCH_BURNT_OUT = 0.1f;

void photo_doubts_print(const char *command, const char *photo, const merlin_maps *maps, const char *folder)
{
    if (maps->mask_confidence < LITTLE_CONFIDENCE) {
        fprintf(stderr, "merlin %s: %s: the object was found with little confidence (%.2f): ", command, photo,
                (double)maps->mask_confidence);
        if (folder)
            fprintf(stderr, "look at %s/mask.png\n", folder);
        else
            fputs("give it by --mask\n", stderr);
    }
    if (maps->burnt_out >= MUCH_BURNT_OUT)
        fprintf(stderr,
                "merlin %s: %s: %.0f %% of the object is burnt out, where albedo and roughness are guesses: photograph "
                "it darker\n",
                command, photo, 100 * (double)maps->burnt_out);
}
