/* SPDX-License-Identifier: MIT */
/* The functions of libmicrohttpd, loaded when a server starts: no other command needs the library.
 *
 *     status s = http_load();
 *     if (s == OK) daemon = http()->start_daemon(...);
 */
#ifndef MERLIN_SERVE_HTTP_HTTP_LIBRARY_H
#define MERLIN_SERVE_HTTP_HTTP_LIBRARY_H

#include <microhttpd.h>

#include "base/status.h"

/* Functions that are used: MHD_NAME for every NAME. */
#define HTTP_FUNCTIONS(USE)                                                                                            \
    USE(add_response_header)                                                                                           \
    USE(create_post_processor)                                                                                         \
    USE(create_response_from_buffer)                                                                                   \
    USE(create_response_from_fd64)                                                                                     \
    USE(destroy_post_processor)                                                                                        \
    USE(destroy_response)                                                                                              \
    USE(get_connection_values)                                                                                         \
    USE(lookup_connection_value)                                                                                       \
    USE(post_process)                                                                                                  \
    USE(queue_response)                                                                                                \
    USE(start_daemon)                                                                                                  \
    USE(stop_daemon)

#define HTTP_MEMBER(name) __typeof__(MHD_##name) *name;
typedef struct http_functions {
    HTTP_FUNCTIONS(HTTP_MEMBER)
} http_functions;
#undef HTTP_MEMBER

status http_load(void);
/* Returns the functions; to be called after http_load. */
const http_functions *http(void);

/* Returns the value of a request's header, or NULL. */
static inline const char *http_header(struct MHD_Connection *c, const char *name)
{
    return http()->lookup_connection_value(c, MHD_HEADER_KIND, name);
}

#endif
