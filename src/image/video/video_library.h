/* SPDX-License-Identifier: MIT */
/* The functions of FFmpeg's libraries, which video_load loads when they are first needed.
 *
 *     status s = video_load(path);
 *     if (s == OK) failed = av()->find_stream_info(context, NULL);
 */
#ifndef MERLIN_IMAGE_VIDEO_VIDEO_LIBRARY_H
#define MERLIN_IMAGE_VIDEO_VIDEO_LIBRARY_H

#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/opt.h>
#include <libavutil/pixdesc.h>
#include <libswscale/swscale.h>

#include "base/status.h"

/* Functions that are used, of each library, with its prefix. */
#define AVFORMAT_FUNCTIONS(USE)                                                                                        \
    USE(avformat_alloc_context)                                                                                        \
    USE(avformat_free_context)                                                                                         \
    USE(avformat_open_input)                                                                                           \
    USE(avformat_close_input)                                                                                          \
    USE(avformat_find_stream_info)                                                                                     \
    USE(avformat_index_get_entries_count)                                                                              \
    USE(avformat_alloc_output_context2)                                                                                \
    USE(avformat_new_stream)                                                                                           \
    USE(avformat_write_header)                                                                                         \
    USE(avio_alloc_context)                                                                                            \
    USE(avio_context_free)                                                                                             \
    USE(avio_size)                                                                                                     \
    USE(avio_open)                                                                                                     \
    USE(avio_closep)                                                                                                   \
    USE(av_find_best_stream)                                                                                           \
    USE(av_guess_frame_rate)                                                                                           \
    USE(av_guess_sample_aspect_ratio)                                                                                  \
    USE(av_interleaved_write_frame)                                                                                    \
    USE(av_read_frame)                                                                                                 \
    USE(av_write_trailer)

#define AVCODEC_FUNCTIONS(USE)                                                                                         \
    USE(avcodec_alloc_context3)                                                                                        \
    USE(avcodec_find_encoder_by_name)                                                                                  \
    USE(avcodec_free_context)                                                                                          \
    USE(avcodec_get_name)                                                                                              \
    USE(avcodec_open2)                                                                                                 \
    USE(avcodec_parameters_from_context)                                                                               \
    USE(avcodec_parameters_to_context)                                                                                 \
    USE(avcodec_receive_frame)                                                                                         \
    USE(avcodec_receive_packet)                                                                                        \
    USE(avcodec_send_frame)                                                                                            \
    USE(avcodec_send_packet)                                                                                           \
    USE(av_packet_alloc)                                                                                               \
    USE(av_packet_free)                                                                                                \
    USE(av_packet_rescale_ts)                                                                                          \
    USE(av_packet_unref)

#define AVUTIL_FUNCTIONS(USE)                                                                                          \
    USE(av_dict_free)                                                                                                  \
    USE(av_dict_set)                                                                                                   \
    USE(av_frame_alloc)                                                                                                \
    USE(av_frame_free)                                                                                                 \
    USE(av_frame_get_buffer)                                                                                           \
    USE(av_frame_make_writable)                                                                                        \
    USE(av_frame_unref)                                                                                                \
    USE(av_free)                                                                                                       \
    USE(av_freep)                                                                                                      \
    USE(av_log_set_level)                                                                                              \
    USE(av_malloc)                                                                                                     \
    USE(av_opt_set)                                                                                                    \
    USE(av_pix_fmt_desc_get)                                                                                           \
    USE(av_strerror)

#define SWSCALE_FUNCTIONS(USE)                                                                                         \
    USE(sws_freeContext)                                                                                               \
    USE(sws_getCoefficients)                                                                                           \
    USE(sws_getContext)                                                                                                \
    USE(sws_isSupportedInput)                                                                                          \
    USE(sws_scale)                                                                                                     \
    USE(sws_setColorspaceDetails)

#define VIDEO_MEMBER(name) __typeof__(name) *name;
typedef struct video_functions {
    AVFORMAT_FUNCTIONS(VIDEO_MEMBER)
    AVCODEC_FUNCTIONS(VIDEO_MEMBER)
    AVUTIL_FUNCTIONS(VIDEO_MEMBER)
    SWSCALE_FUNCTIONS(VIDEO_MEMBER)
} video_functions;
#undef VIDEO_MEMBER

/* Loads the functions; path: the video for which they are needed, for the message of a failure. Their messages to
 * standard error are switched off, for all of the process. */
status video_load(const char *path);
/* Returns the functions, after video_load. */
const video_functions *av(void);

/* The file's bytes for libavformat; libraries are never given a name to open, which a file's content could replace by
 * that of another file or host. NULL without memory. The caller gives it back by video_bytes_close. */
AVIOContext *video_bytes_open(FILE *file);
void video_bytes_close(AVIOContext **bytes);

#endif
