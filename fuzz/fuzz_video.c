/* SPDX-License-Identifier: MIT */
/* Videos from arbitrary bytes: the frames that are accepted have the head's size, three channels and finite values. */
#include "fuzz_picture.h"
#include "image/video/video_read.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    enum { MOST_FRAMES = 8 };
    const char *path = fuzz_file(data, size);
    img_video *v;
    bool end = false;
    if (!img_is_video(path) || img_video_open(path, &v) != OK) return 0;
    const img_video_head *head = img_video_head_of(v);
    for (int i = 0; i < MOST_FRAMES && !end; i++) {
        img frame;
        if (img_video_next(v, &frame, &end) != OK || end) break;
        if (frame.channels != 3 || frame.width != head->width || frame.height != head->height) abort();
        fuzz_check_values(&frame, 0, INFINITY);
        img_free(&frame);
    }
    img_video_close(v);
    if (strchr(status_message(), '\n')) abort();
    return 0;
}
