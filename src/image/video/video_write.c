/* SPDX-License-Identifier: MIT */
#include "image/video/video_write.h"

#include <errno.h>
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "image/color.h"
#include "image/video/video_library.h"

struct img_video_out {
    char *path, *aside; /* the name, and that under which it is written */
    AVFormatContext *output;
    AVCodecContext *encoder;
    AVStream *stream;
    AVPacket *packet;
    AVFrame *frame;
    struct SwsContext *scaler;
    uint8_t *codes; /* a picture's red, green, blue */
    size_t stride;
    bool begun; /* the file's head is written */
    int64_t count;
};

static status refusal(const img_video_out *v, int error)
{
    if (error == AVERROR(ENOMEM)) return fail(MERLIN_NO_MEMORY, "no memory to write the video %s", v->path);
    char words[AV_ERROR_MAX_STRING_SIZE] = "";
    av()->av_strerror(error, words, sizeof words);
    return fail(MERLIN_CANNOT_WRITE, "cannot write the video %s: %s", v->path, words);
}

static void set_up(AVCodecContext *c, int width, int height, double rate)
{
    c->width = width & ~1;
    c->height = height & ~1;
    c->pix_fmt = AV_PIX_FMT_YUV420P;
    c->framerate = (AVRational){(int)lround(rate * 1000), 1000};
    c->time_base = (AVRational){c->framerate.den, c->framerate.num};
    c->color_range = AVCOL_RANGE_MPEG;
    c->colorspace = AVCOL_SPC_BT709;
    c->color_primaries = AVCOL_PRI_BT709;
    c->color_trc = AVCOL_TRC_IEC61966_2_1; /* as pictures are written */
    c->thread_count = 1;
}

/* Opens the first of these encoders that is there and works. */
static status open_encoder(img_video_out *v, int width, int height, double rate)
{
    static const char *const encoders[] = {"libx264", "libopenh264", "mpeg4"};
    for (size_t i = 0; i < sizeof encoders / sizeof *encoders; i++) {
        const AVCodec *codec = av()->avcodec_find_encoder_by_name(encoders[i]);
        if (!codec) continue;
        v->encoder = av()->avcodec_alloc_context3(codec);
        if (!v->encoder) return refusal(v, AVERROR(ENOMEM));
        set_up(v->encoder, width, height, rate);
        if (v->output->oformat->flags & AVFMT_GLOBALHEADER) v->encoder->flags |= AV_CODEC_FLAG_GLOBAL_HEADER;
        if (i == 0) av()->av_opt_set(v->encoder->priv_data, "crf", "16", 0);
        if (i > 0) v->encoder->bit_rate = (int64_t)(0.4 * rate * width * height) + 400000;
        if (av()->avcodec_open2(v->encoder, codec, NULL) == 0) return OK;
        av()->avcodec_free_context(&v->encoder);
    }
    return fail(MERLIN_DEVICE_FAILED, "cannot write the video %s: the FFmpeg installed here has no encoder for it",
                v->path);
}

static status open_output(img_video_out *v, int width, int height, double rate)
{
    char url[PATH_MAX + 8];
    snprintf(url, sizeof url, "file:%s", v->aside); /* a name with a colon would be that of a protocol */
    int error = av()->avformat_alloc_output_context2(&v->output, NULL, "mp4", url);
    if (error < 0) return refusal(v, error);
    status s = open_encoder(v, width, height, rate);
    if (s != OK) return s;
    v->stream = av()->avformat_new_stream(v->output, NULL);
    v->packet = av()->av_packet_alloc();
    v->frame = av()->av_frame_alloc();
    if (!v->stream || !v->packet || !v->frame) return refusal(v, AVERROR(ENOMEM));
    error = av()->avcodec_parameters_from_context(v->stream->codecpar, v->encoder);
    v->stream->time_base = v->encoder->time_base;
    v->stream->avg_frame_rate = v->encoder->framerate;
    v->frame->format = v->encoder->pix_fmt;
    v->frame->width = v->encoder->width;
    v->frame->height = v->encoder->height;
    v->frame->color_range = v->encoder->color_range;
    v->frame->colorspace = v->encoder->colorspace;
    if (!error) error = av()->av_frame_get_buffer(v->frame, 0);
    if (!error) error = av()->avio_open(&v->output->pb, v->output->url, AVIO_FLAG_WRITE);
    if (error >= 0) error = av()->avformat_write_header(v->output, NULL);
    v->begun = error >= 0;
    return error < 0 ? refusal(v, error) : OK;
}

static status open_scaler(img_video_out *v)
{
    const int width = v->encoder->width, height = v->encoder->height, even = 1 << 16;
    v->scaler =
        av()->sws_getContext(width, height, AV_PIX_FMT_RGB24, width, height, AV_PIX_FMT_YUV420P,
                             SWS_BICUBIC | SWS_ACCURATE_RND | SWS_BITEXACT | SWS_FULL_CHR_H_INT, NULL, NULL, NULL);
    v->stride = ((size_t)width * 3 + 127) / 64 * 64;
    v->codes = calloc((size_t)height + 1, v->stride);
    if (!v->scaler || !v->codes) return refusal(v, AVERROR(ENOMEM));
    const int *table = av()->sws_getCoefficients(SWS_CS_ITU709);
    (void)av()->sws_setColorspaceDetails(v->scaler, table, 1, table, 0, 0, even, even);
    return OK;
}

status img_video_create(const char *path, int width, int height, double rate, img_video_out **out)
{
    *out = NULL;
    if (width < 2 || height < 2 || !(rate >= 0.1 && rate <= 1000))
        return fail(MERLIN_WRONG_USE, "a video has at least 2×2 pixels and 0.1 to 1000 frames a second");
    status s = video_load(path);
    if (s != OK) return s;
    img_video_out *v = calloc(1, sizeof *v);
    if (v) v->path = strdup(path);
    if (!v || !v->path) {
        free(v);
        return fail(MERLIN_NO_MEMORY, "no memory to write the video %s", path);
    }
    s = file_temporary(path, &v->aside);
    if (s == OK) s = open_output(v, width, height, rate);
    if (s == OK) s = open_scaler(v);
    if (s == OK)
        *out = v;
    else
        (void)img_video_finish(v, s);
    return s;
}

/* Hands the encoder a frame, or NULL for the end, and writes what it returns. */
static status encode(img_video_out *v, const AVFrame *frame)
{
    int error = av()->avcodec_send_frame(v->encoder, frame);
    while (error >= 0) {
        error = av()->avcodec_receive_packet(v->encoder, v->packet);
        if (error == AVERROR(EAGAIN) || error == AVERROR_EOF) return OK;
        if (error < 0) break;
        v->packet->stream_index = v->stream->index;
        if (v->packet->duration == 0) v->packet->duration = 1;
        av()->av_packet_rescale_ts(v->packet, v->encoder->time_base, v->stream->time_base);
        error = av()->av_interleaved_write_frame(v->output, v->packet);
    }
    return refusal(v, error);
}

status img_video_add(img_video_out *v, const img *frame)
{
    if (frame->channels != 3 || (frame->width & ~1) != v->encoder->width || (frame->height & ~1) != v->encoder->height)
        return fail(MERLIN_WRONG_USE, "a frame of %d×%d pixels and %d channels does not belong into the video %s",
                    frame->width, frame->height, frame->channels, v->path);
    for (int y = 0; y < v->encoder->height; y++)
        srgb_codes8(img_at(frame, 0, y), 3 * (size_t)v->encoder->width, v->codes + (size_t)y * v->stride);
    const uint8_t *rows[4] = {v->codes};
    const int strides[4] = {(int)v->stride};
    int error = av()->av_frame_make_writable(v->frame);
    if (error < 0) return refusal(v, error);
    (void)av()->sws_scale(v->scaler, rows, strides, 0, v->encoder->height, v->frame->data, v->frame->linesize);
    v->frame->pts = v->count++;
    return encode(v, v->frame);
}

status img_video_finish(img_video_out *v, status s)
{
    if (s == OK) s = encode(v, NULL);
    if (v->begun) {
        int error = av()->av_write_trailer(v->output);
        if (s == OK && error < 0) s = refusal(v, error);
    }
    if (v->output && v->output->pb) {
        int error = v->output->pb->error, closed = av()->avio_closep(&v->output->pb);
        if (s == OK && (error < 0 || closed < 0)) s = refusal(v, error < 0 ? error : closed);
    }
    if (v->scaler) av()->sws_freeContext(v->scaler);
    av()->av_frame_free(&v->frame);
    av()->av_packet_free(&v->packet);
    av()->avcodec_free_context(&v->encoder);
    av()->avformat_free_context(v->output);
    if (v->aside && s == OK)
        s = file_commit(v->aside, v->path);
    else if (v->aside)
        file_discard(v->aside);
    free(v->codes);
    free(v->path);
    free(v);
    return s;
}
