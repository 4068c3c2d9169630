/* SPDX-License-Identifier: MIT */
#include "lab/onnx/protobuf.h"

#include <stdlib.h>
#include <string.h>

/* Encodings of the bytes after a field's number. */
enum { WIRE_INTEGER = 0, WIRE_BYTES = 2, WIRE_FLOAT = 5, WIRE_BITS = 3 };

void protobuf_free(protobuf *message)
{
    free(message->data);
    *message = (protobuf){0};
}

static void lose(protobuf *message)
{
    protobuf_free(message);
    message->lost = true;
}

static void append(protobuf *m, const void *data, size_t size)
{
    if (m->lost) return;
    if (m->size + size > m->room) {
        size_t room = 2 * (m->size + size);
        uint8_t *more = realloc(m->data, room);
        if (!more) {
            lose(m);
            return;
        }
        m->data = more;
        m->room = room;
    }
    if (size) memcpy(m->data + m->size, data, size);
    m->size += size;
}

/* Appends seven bits per byte, the lowest first; all bytes but the last have the eighth bit set. */
static void append_varint(protobuf *m, uint64_t value)
{
    uint8_t bytes[10];
    size_t count = 0;
    for (; value > 127; value >>= 7)
        bytes[count++] = (uint8_t)(value | 128);
    bytes[count++] = (uint8_t)value;
    append(m, bytes, count);
}

static void append_key(protobuf *m, int field, int wire)
{
    append_varint(m, (uint64_t)field << WIRE_BITS | (uint64_t)wire);
}

void protobuf_integer(protobuf *message, int field, int64_t value)
{
    append_key(message, field, WIRE_INTEGER);
    append_varint(message, (uint64_t)value);
}

void protobuf_float(protobuf *message, int field, float value)
{
    append_key(message, field, WIRE_FLOAT);
    append(message, &value, sizeof value);
}

void protobuf_bytes(protobuf *message, int field, const void *data, size_t size)
{
    append_key(message, field, WIRE_BYTES);
    append_varint(message, size);
    append(message, data, size);
}

void protobuf_text(protobuf *message, int field, const char *text)
{
    protobuf_bytes(message, field, text, strlen(text));
}

void protobuf_message(protobuf *message, int field, protobuf *part)
{
    if (part->lost)
        lose(message);
    else
        protobuf_bytes(message, field, part->data, part->size);
    protobuf_free(part);
}
