/* SPDX-License-Identifier: MIT */
/* Makes a video of pictures, each of which stays for some frames:
 *
 *     pictures_video OUT.mp4 FRAMES PICTURE...
 */
#include <stdio.h>
#include <stdlib.h>

#include "merlin/merlin.h"

enum { RATE = 25 };

static void check(merlin_status s)
{
    if (s == MERLIN_OK) return;
    fprintf(stderr, "pictures_video: %s\n", merlin_error());
    exit(1);
}

int main(int argc, char **argv)
{
    merlin_video *video = NULL;
    if (argc < 4) return 2;
    for (int i = 3; i < argc; i++) {
        merlin_image picture;
        check(merlin_image_read(argv[i], &picture, NULL));
        if (!video) check(merlin_video_create(argv[1], picture.width, picture.height, RATE, &video));
        for (int k = 0; k < atoi(argv[2]); k++)
            check(merlin_video_add(video, &picture));
        merlin_image_free(&picture);
    }
    check(merlin_video_finish(video, 1));
    return 0;
}
