/* SPDX-License-Identifier: MIT */
/* Answers to requests, with the headers that every answer has. */
#ifndef MERLIN_SERVE_HTTP_ANSWER_H
#define MERLIN_SERVE_HTTP_ANSWER_H

#include <cJSON.h>
#include <stdint.h>

#include "serve/http/http_library.h"

/* {"code": CODE, "error": words}: one line for a person, and a name for programs. */
enum MHD_Result answer_error(struct MHD_Connection *c, unsigned status_code, const char *code, const char *words);
/* Frees json; NULL is a lack of memory, which is told. location (may be NULL): of what was made. */
enum MHD_Result answer_json(struct MHD_Connection *c, unsigned status_code, cJSON *json, const char *location);
/* Takes the descriptor over. name tells the type, and whether a browser shows it or saves it. */
enum MHD_Result answer_file(struct MHD_Connection *c, int descriptor, uint64_t bytes, const char *name);
/* text stays the caller's, for ever. csp: the page's content security policy. */
enum MHD_Result answer_text(struct MHD_Connection *c, const char *type, const char *text, const char *csp);
enum MHD_Result answer_nothing(struct MHD_Connection *c);
/* Leads a browser to the page, which it asks for with a cookie from then on. */
enum MHD_Result answer_signed_in(struct MHD_Connection *c, const char *cookie);

#endif
