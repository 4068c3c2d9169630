/* SPDX-License-Identifier: MIT */
/* Just enough of Protocol Buffers to write an ONNX model: growing messages that can hold one another.
 *
 *     pb node = {0};
 *     pb_text(&node, 4, "Relu");
 *     pb_message(&graph, 1, &node);        takes the message over and frees it */
#ifndef MERLIN_TESTS_PEERS_PROTOBUF_H
#define MERLIN_TESTS_PEERS_PROTOBUF_H

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

typedef struct pb {
    uint8_t *data;
    size_t size, room;
} pb;

static inline void pb_append(pb *m, const void *data, size_t size)
{
    if (m->size + size > m->room) {
        m->room = 2 * (m->size + size);
        m->data = realloc(m->data, m->room);
        if (!m->data) abort(); /* a tool of the tests */
    }
    if (size) memcpy(m->data + m->size, data, size);
    m->size += size;
}

static inline void pb_varint(pb *m, uint64_t value)
{
    uint8_t bytes[10];
    int count = 0;
    for (; value > 127; value >>= 7)
        bytes[count++] = (uint8_t)(value | 128);
    bytes[count++] = (uint8_t)value;
    pb_append(m, bytes, (size_t)count);
}

static inline void pb_integer(pb *m, int field, int64_t value)
{
    pb_varint(m, (uint64_t)field << 3);
    pb_varint(m, (uint64_t)value);
}

static inline void pb_float(pb *m, int field, float value)
{
    pb_varint(m, (uint64_t)field << 3 | 5);
    pb_append(m, &value, sizeof value);
}

static inline void pb_bytes(pb *m, int field, const void *data, size_t size)
{
    pb_varint(m, (uint64_t)field << 3 | 2);
    pb_varint(m, size);
    pb_append(m, data, size);
}

static inline void pb_text(pb *m, int field, const char *text)
{
    pb_bytes(m, field, text, strlen(text));
}

static inline void pb_message(pb *m, int field, pb *inner)
{
    pb_bytes(m, field, inner->data, inner->size);
    free(inner->data);
    *inner = (pb){0};
}

#endif
