/* SPDX-License-Identifier: MIT */
#include "image/video/video_read.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "image/formats/img_format.h"
#include "image/metadata/picture_size.h"
#include "image/video/video_frame.h"
#include "image/video/video_library.h"

/* Containers that are opened. Others of libavformat are lists of further files and hosts, or need its network. */
static const char containers[] = "mov,mp4,matroska,webm,avi,mpegts,mpeg,ogg,asf,flv,mxf,yuv4mpegpipe,nut,ivf";

struct img_video {
    char *path;
    FILE *file;
    AVIOContext *bytes;
    AVFormatContext *input;
    AVCodecContext *decoder;
    AVPacket *packet;
    AVFrame *frame;
    bool held; /* `frame` was decoded, but not returned */
    const AVStream *stream;
    video_converter converter;
    img_video_head head;
    long packets, frames; /* numbers of those that were read and returned */
    long indexed;         /* number of packets by an index that lists all; 0: unknown */
    int64_t bytes_end;    /* where the last packet ends in the file; 0: unknown */
    double seconds_end;   /* time at which the last one of any stream ends */
    bool drained;         /* the decoder was told that nothing follows */
};

/* ---- what is a video ---- */

typedef struct video_mark {
    size_t at, count;
    char bytes[12];
} video_mark;

static bool has_mark(const uint8_t *head, size_t size)
{
    static const video_mark marks[] = {
        {4, 4, "ftyp"},
        {4, 4, "moov"},
        {4, 4, "mdat"},
        {4, 4, "wide"},
        {4, 4, "skip"},
        {0, 4, "\x1a\x45\xdf\xa3"},
        {8, 4, "AVI "},
        {0, 4, "OggS"},
        {0, 4, "FLV\1"},
        {0, 9, "YUV4MPEG2"},
        {0, 4, "\0\0\1\xba"},
        {0, 8, "\x30\x26\xb2\x75\x8e\x66\xcf\x11"},
        {0, 4, "\x06\x0e\x2b\x34"},
        {0, 4, "DKIF"},
    };
    for (size_t i = 0; i < sizeof marks / sizeof *marks; i++)
        if (size >= marks[i].at + marks[i].count && memcmp(head + marks[i].at, marks[i].bytes, marks[i].count) == 0)
            return true;
    /* packets of a transport stream, alone or behind four bytes of time each */
    return (size > 376 && head[0] == 'G' && head[188] == 'G' && head[376] == 'G') ||
           (size > 388 && head[4] == 'G' && head[196] == 'G' && head[388] == 'G');
}

bool img_is_video(const char *path)
{
    uint8_t head[IMG_FORMAT_HEAD];
    FILE *file = file_check_plain(path) == OK ? file_open(path) : NULL;
    if (!file) return false;
    size_t size = fread(head, 1, sizeof head, file);
    fclose(file);
    return has_mark(head, size) && !img_format_of_head(head, size).name;
}

/* ---- opening ---- */

static status damaged(const img_video *v)
{
    if (v->frames == 0) return fail(MERLIN_BAD_INPUT, "the video %s is damaged or cut short", v->path);
    return fail(MERLIN_BAD_INPUT, "the video %s is damaged or cut short after frame %ld", v->path, v->frames);
}

static status refusal(const img_video *v, int error)
{
    if (error == AVERROR(ENOMEM)) return fail(MERLIN_NO_MEMORY, "no memory to read the video %s", v->path);
    return damaged(v);
}

static status open_input(img_video *v)
{
    AVDictionary *options = NULL;
    v->file = file_open(v->path);
    if (!v->file) return fail_by_errno(MERLIN_BAD_INPUT, "cannot read the video %s", v->path);
    v->bytes = video_bytes_open(v->file);
    v->input = av()->avformat_alloc_context();
    v->packet = av()->av_packet_alloc();
    v->frame = av()->av_frame_alloc();
    if (!v->bytes || !v->input || !v->packet || !v->frame) return refusal(v, AVERROR(ENOMEM));
    v->input->pb = v->bytes;
    av()->av_dict_set(&options, "format_whitelist", containers, 0);
    av()->av_dict_set(&options, "protocol_whitelist", "none", 0);
    int error = av()->avformat_open_input(&v->input, NULL, NULL, &options);
    av()->av_dict_free(&options);
    if (!error) error = av()->avformat_find_stream_info(v->input, NULL);
    return error < 0 ? refusal(v, error) : OK;
}

static status open_decoder(img_video *v)
{
    const AVCodec *codec = NULL;
    const int found = av()->av_find_best_stream(v->input, AVMEDIA_TYPE_VIDEO, -1, -1, &codec, 0);
    if (found == AVERROR_DECODER_NOT_FOUND)
        return fail(MERLIN_BAD_INPUT, "the video %s is in a format that the FFmpeg installed here does not decode",
                    v->path);
    if (found < 0 || !codec) return fail(MERLIN_BAD_INPUT, "there are no pictures in %s", v->path);
    v->stream = v->input->streams[found];
    v->decoder = av()->avcodec_alloc_context3(codec);
    if (!v->decoder) return refusal(v, AVERROR(ENOMEM));
    int error = av()->avcodec_parameters_to_context(v->decoder, v->stream->codecpar);
    /* one frame at a time: threads would hold several */
    v->decoder->thread_count = 1;
    v->decoder->max_pixels = IMAGE_MOST_PIXELS;
    v->decoder->pkt_timebase = v->stream->time_base;
    if (!error) error = av()->avcodec_open2(v->decoder, codec, NULL);
    return error < 0 ? refusal(v, error) : OK;
}

/* ---- decoding ---- */

/* Notes where a packet ends. */
static void note_end(img_video *v)
{
    const AVPacket *p = v->packet;
    const AVRational unit = v->input->streams[p->stream_index]->time_base;
    v->bytes_end = p->pos > 0 ? p->pos + p->size : 0;
    if (p->pts == AV_NOPTS_VALUE) return;
    double end = (double)(p->pts + (p->duration > 0 ? p->duration : 0)) * unit.num / unit.den;
    if (v->input->start_time != AV_NOPTS_VALUE) end -= (double)v->input->start_time / AV_TIME_BASE;
    if (end > v->seconds_end) v->seconds_end = end;
}

/* Tells whether the packets end before the file's head says: many containers have no mark at their end. */
static bool is_cut_short(const img_video *v)
{
    const double slack = v->head.rate > 0 ? fmax(3 / v->head.rate, 0.1) : 0.5;
    const char *name = v->input->iformat->name;
    if (v->indexed) return v->packets < v->indexed;
    if (strcmp(name, "yuv4mpegpipe") == 0) return v->bytes_end && v->bytes_end != av()->avio_size(v->bytes);
    const bool states = strncmp(name, "matroska", 8) == 0 || strcmp(name, "avi") == 0;
    return states && v->input->duration_estimation_method == AVFMT_DURATION_FROM_STREAM &&
           v->seconds_end + slack < (double)v->input->duration / AV_TIME_BASE;
}

/* Gives the decoder the stream's next packet, or tells it that there is none. */
static status feed(img_video *v)
{
    if (v->drained) return damaged(v);
    int error = av()->av_read_frame(v->input, v->packet);
    if (error == AVERROR_EOF && !v->bytes->error) {
        if (is_cut_short(v)) return damaged(v);
        v->drained = true;
        return av()->avcodec_send_packet(v->decoder, NULL) == 0 ? OK : damaged(v);
    }
    if (error < 0) return refusal(v, error);
    note_end(v);
    if (v->packet->stream_index == v->stream->index) {
        v->packets++;
        error = v->packet->flags & AV_PKT_FLAG_CORRUPT ? AVERROR_INVALIDDATA
                                                       : av()->avcodec_send_packet(v->decoder, v->packet);
    }
    av()->av_packet_unref(v->packet);
    return error < 0 ? refusal(v, error) : OK;
}

/* Decodes the next frame into `frame`. */
static status decode(img_video *v, bool *end)
{
    *end = false;
    for (;;) {
        int error = av()->avcodec_receive_frame(v->decoder, v->frame);
        if (error == AVERROR_EOF) {
            *end = true;
            return OK;
        }
        if (error != 0 && error != AVERROR(EAGAIN)) return refusal(v, error);
        if (error == 0 && (v->frame->decode_error_flags || (v->frame->flags & AV_FRAME_FLAG_CORRUPT)))
            return damaged(v);
        if (error == 0) return OK;
        status s = feed(v);
        if (s != OK) return s;
    }
}

/* Returns the container's matrix of the way upright, or NULL. */
static const int32_t *display_matrix(const AVStream *stream)
{
#if LIBAVCODEC_VERSION_INT >= AV_VERSION_INT(60, 30, 100)
    const AVPacketSideData *data = stream->codecpar->coded_side_data;
    const int count = stream->codecpar->nb_coded_side_data;
#else
    const AVPacketSideData *data = stream->side_data;
    const int count = stream->nb_side_data;
#endif
    for (int i = 0; i < count; i++)
        if (data[i].type == AV_PKT_DATA_DISPLAYMATRIX && data[i].size >= 9 * sizeof(int32_t))
            return (const int32_t *)(const void *)data[i].data;
    return NULL;
}

static double number_of(AVRational r)
{
    return r.num > 0 && r.den > 0 ? (double)r.num / (double)r.den : 0;
}

static void find_head(img_video *v)
{
    AVStream *stream = v->input->streams[v->stream->index];
    const video_converter *c = &v->converter;
    const bool across = c->turn.along[0] == 0;
    const double seconds = v->input->duration > 0 ? (double)v->input->duration / AV_TIME_BASE : 0;
    double rate = number_of(stream->avg_frame_rate);
    if (!(rate > 0)) rate = number_of(av()->av_guess_frame_rate(v->input, stream, NULL));
    if (!(rate > 0 && rate < 10000)) rate = 0;
    long frames = stream->nb_frames > 0 && stream->nb_frames < INT32_MAX ? (long)stream->nb_frames : 0;
    if (!frames && rate * seconds < 1e9) frames = (long)(rate * seconds + 0.5);
    const enum AVFieldOrder order = v->stream->codecpar->field_order;
    v->head = (img_video_head){.width = across ? c->high : c->wide,
                               .height = across ? c->wide : c->high,
                               .rate = rate,
                               .frames = frames,
                               .interlaced = order != AV_FIELD_UNKNOWN && order != AV_FIELD_PROGRESSIVE,
                               .bright = c->bright};
    if (strncmp(v->input->iformat->name, "mov", 3) == 0) v->indexed = av()->avformat_index_get_entries_count(stream);
}

/* Decodes the first frame, which states size and colours for certain. */
static status open_first(img_video *v)
{
    video_turn turn;
    bool end;
    if (!video_turn_of(display_matrix(v->stream), &turn))
        return fail(MERLIN_BAD_INPUT, "the video %s is to be shown tilted; turn it upright first", v->path);
    status s = decode(v, &end);
    if (s == OK && end) s = fail(MERLIN_BAD_INPUT, "there are no pictures in %s", v->path);
    if (s != OK) return s;
    v->held = true;
    const double aspect =
        number_of(av()->av_guess_sample_aspect_ratio(v->input, v->input->streams[v->stream->index], v->frame));
    s = video_converter_new(v->path, v->frame, aspect, turn, &v->converter);
    if (s == OK) find_head(v);
    return s;
}

status img_video_open(const char *path, img_video **out)
{
    *out = NULL;
    status s = file_check_plain(path);
    if (s == OK) s = video_load(path);
    if (s != OK) return s;
    img_video *v = calloc(1, sizeof *v);
    if (v) v->path = strdup(path);
    if (!v || !v->path) {
        free(v);
        return fail(MERLIN_NO_MEMORY, "no memory to read the video %s", path);
    }
    s = open_input(v);
    if (s == OK) s = open_decoder(v);
    if (s == OK) s = open_first(v);
    if (s == OK)
        *out = v;
    else
        img_video_close(v);
    return s;
}

const img_video_head *img_video_head_of(const img_video *v)
{
    return &v->head;
}

status img_video_next(img_video *v, img *frame, bool *end)
{
    *frame = (img){0};
    *end = false;
    status s = v->held ? OK : decode(v, end);
    v->held = false;
    if (s != OK || *end) return s;
    if (!video_converter_suits(&v->converter, v->frame))
        s = fail(MERLIN_BAD_INPUT, "frame %ld of the video %s is of %d×%d pixels or another kind than the first",
                 v->frames + 1, v->path, v->frame->width, v->frame->height);
    if (s == OK) s = video_converter_run(&v->converter, v->frame, frame);
    av()->av_frame_unref(v->frame);
    if (s == OK) v->frames++;
    return s;
}

void img_video_close(img_video *v)
{
    if (!v) return;
    video_converter_free(&v->converter);
    av()->av_frame_free(&v->frame);
    av()->av_packet_free(&v->packet);
    av()->avcodec_free_context(&v->decoder);
    av()->avformat_close_input(&v->input);
    video_bytes_close(&v->bytes);
    if (v->file) fclose(v->file);
    free(v->path);
    free(v);
}
