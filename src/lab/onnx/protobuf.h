/* SPDX-License-Identifier: MIT */
/* Protocol Buffers, as far as writing a message takes: bytes that grow, and messages that hold one another.
 *
 *     protobuf node = {0};
 *     protobuf_text(&node, 4, "Relu");
 *     protobuf_message(&graph, 1, &node);
 *
 * A message that ran out of memory is `lost`, as is every one that it becomes a part of, so that only the outermost
 * needs to be asked. Source: "Encoding", protobuf.dev. */
#ifndef MERLIN_LAB_ONNX_PROTOBUF_H
#define MERLIN_LAB_ONNX_PROTOBUF_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Zero-initialized it is empty. */
typedef struct protobuf {
    uint8_t *data;
    size_t size, room;
    bool lost; /* memory ran out: data is NULL */
} protobuf;

void protobuf_free(protobuf *message);

/* Append a field: an integer, a float, bytes, a text. */
void protobuf_integer(protobuf *message, int field, int64_t value);
void protobuf_float(protobuf *message, int field, float value);
void protobuf_bytes(protobuf *message, int field, const void *data, size_t size);
void protobuf_text(protobuf *message, int field, const char *text);
/* Appends a message as a field of another, and empties it. */
void protobuf_message(protobuf *message, int field, protobuf *part);

#endif
