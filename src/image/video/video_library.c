/* SPDX-License-Identifier: MIT */
#include "image/video/video_library.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/library.h"

static video_functions functions;
#define WANTED(name) {#name, &functions.name},
static const library_function of_format[] = {AVFORMAT_FUNCTIONS(WANTED)};
static const library_function of_codec[] = {AVCODEC_FUNCTIONS(WANTED)};
static const library_function of_util[] = {AVUTIL_FUNCTIONS(WANTED)};
static const library_function of_scale[] = {SWSCALE_FUNCTIONS(WANTED)};
static library libraries[] = {
    {.file = MERLIN_AVUTIL, .functions = of_util, .count = sizeof of_util / sizeof *of_util},
    {.file = MERLIN_AVCODEC, .functions = of_codec, .count = sizeof of_codec / sizeof *of_codec},
    {.file = MERLIN_AVFORMAT, .functions = of_format, .count = sizeof of_format / sizeof *of_format},
    {.file = MERLIN_SWSCALE, .functions = of_scale, .count = sizeof of_scale / sizeof *of_scale},
};

status video_load(const char *path)
{
    for (size_t i = 0; i < sizeof libraries / sizeof *libraries; i++) {
        status s = library_need(&libraries[i]);
        if (s != OK) return fail_in(s, "videos such as %s need FFmpeg's libraries (install the package ffmpeg)", path);
    }
    if (!getenv("MERLIN_LIBRARY_MESSAGES")) functions.av_log_set_level(AV_LOG_QUIET);
    return OK;
}

const video_functions *av(void)
{
    return &functions;
}

static int read_bytes(void *file, uint8_t *to, int size)
{
    size_t count = fread(to, 1, (size_t)size, file);
    if (count > 0) return (int)count;
    return ferror(file) ? AVERROR(EIO) : AVERROR_EOF;
}

static int64_t seek_bytes(void *file, int64_t offset, int whence)
{
    const off_t now = ftello(file);
    off_t size = fseeko(file, 0, SEEK_END) == 0 ? ftello(file) : -1;
    if (whence & AVSEEK_SIZE) {
        if (now < 0 || fseeko(file, now, SEEK_SET) != 0) return AVERROR(EIO);
        return size;
    }
    int64_t to = (whence & ~AVSEEK_FORCE) == SEEK_CUR   ? now + offset
                 : (whence & ~AVSEEK_FORCE) == SEEK_END ? size + offset
                                                        : offset;
    /* behind the end there is nothing: what leads there was cut short */
    if (to < 0 || to > size) {
        (void)fseeko(file, now, SEEK_SET);
        return AVERROR(EINVAL);
    }
    return fseeko(file, to, SEEK_SET) == 0 ? to : AVERROR(EIO);
}

AVIOContext *video_bytes_open(FILE *file)
{
    enum { BUFFER = 1 << 16 };
    unsigned char *buffer = functions.av_malloc(BUFFER);
    AVIOContext *made =
        buffer ? functions.avio_alloc_context(buffer, BUFFER, 0, file, read_bytes, NULL, seek_bytes) : NULL;
    if (!made) functions.av_free(buffer);
    return made;
}

void video_bytes_close(AVIOContext **bytes)
{
    if (!*bytes) return;
    functions.av_freep(&(*bytes)->buffer);
    functions.avio_context_free(bytes);
}
