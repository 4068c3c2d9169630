/* SPDX-License-Identifier: MIT */
/* Responses to requests, with the headers of every response. */
#ifndef MERLIN_SERVE_HTTP_ANSWER_H
#define MERLIN_SERVE_HTTP_ANSWER_H

#include <cjson/cJSON.h>
#include <stdint.h>

#include "serve/http/http_library.h"

/* Sends {"code": CODE, "error": words}: a name for programs, and one line for people. */
enum MHD_Result answer_error(struct MHD_Connection *c, unsigned status_code, const char *code, const char *words);
/* Refuses a method; allow: those of the resource, "GET, HEAD". */
enum MHD_Result answer_no_method(struct MHD_Connection *c, const char *allow);
/* Sends json and frees it; NULL means lack of memory, which is reported. location (may be NULL): path of a new
 * resource. */
enum MHD_Result answer_json(struct MHD_Connection *c, unsigned status_code, cJSON *json, const char *location);
/* Sends a file and takes over the descriptor. name determines the type, and whether a browser shows or saves it. */
enum MHD_Result answer_file(struct MHD_Connection *c, int descriptor, uint64_t bytes, const char *name);
/* Sends text, which must stay valid. csp: the page's content security policy. */
enum MHD_Result answer_text(struct MHD_Connection *c, const char *type, const char *text, const char *csp);
enum MHD_Result answer_nothing(struct MHD_Connection *c);
/* Redirects a browser to the page, with a cookie for further requests. */
enum MHD_Result answer_signed_in(struct MHD_Connection *c, const char *cookie);

#endif
