/* SPDX-License-Identifier: MIT */
#include "serve/http/answer.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/file.h"
#include "base/json/json_put.h"

/* Content security policy of results: their pages run their own scripts and access nothing. */
#define RESULT_POLICY                                                                                                  \
    "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src 'self' data: blob:; "          \
    "connect-src data: blob:; frame-ancestors 'self'; base-uri 'none'; form-action 'none'"
#define NO_POLICY "default-src 'none'; frame-ancestors 'none'"

static void put(struct MHD_Response *r, const char *name, const char *value)
{
    (void)http()->add_response_header(r, name, value);
}

static enum MHD_Result send_with(struct MHD_Connection *c, unsigned status_code, struct MHD_Response *r,
                                 const char *type, const char *csp)
{
    if (!r) return MHD_NO; /* without memory the connection is closed */
    put(r, "Content-Type", type);
    put(r, "Content-Security-Policy", csp);
    put(r, "X-Content-Type-Options", "nosniff");
    put(r, "Cross-Origin-Resource-Policy", "same-origin");
    put(r, "Referrer-Policy", "no-referrer");
    put(r, "Cache-Control", "no-store");
    enum MHD_Result sent = http()->queue_response(c, status_code, r);
    http()->destroy_response(r);
    return sent;
}

enum MHD_Result answer_json(struct MHD_Connection *c, unsigned status_code, cJSON *json, const char *location)
{
    char *text = json_print_line(json);
    cJSON_Delete(json);
    if (!text) return answer_error(c, MHD_HTTP_SERVICE_UNAVAILABLE, "no_memory", "no memory for an answer");
    struct MHD_Response *r = http()->create_response_from_buffer(strlen(text), text, MHD_RESPMEM_MUST_FREE);
    if (!r) free(text);
    if (r && location) put(r, "Location", location);
    return send_with(c, status_code, r, "application/json", NO_POLICY);
}

static enum MHD_Result answer_refusal(struct MHD_Connection *c, unsigned status_code, const char *code,
                                      const char *words, const char *allow)
{
    static const char *const lack = "{\"code\":\"no_memory\",\"error\":\"no memory for an answer\"}";
    cJSON *o = cJSON_CreateObject();
    json_put_text(o, "code", code);
    json_put_text(o, "error", words);
    char *text = json_print_line(o);
    cJSON_Delete(o);
    struct MHD_Response *r =
        text ? http()->create_response_from_buffer(strlen(text), text, MHD_RESPMEM_MUST_FREE)
             : http()->create_response_from_buffer(strlen(lack), (void *)lack, MHD_RESPMEM_PERSISTENT);
    if (!r) free(text);
    if (r && status_code == MHD_HTTP_UNAUTHORIZED) put(r, "WWW-Authenticate", "Bearer");
    if (r && status_code == MHD_HTTP_SERVICE_UNAVAILABLE) put(r, "Retry-After", "5");
    if (r && allow) put(r, "Allow", allow);
    return send_with(c, status_code, r, "application/json", NO_POLICY);
}

enum MHD_Result answer_error(struct MHD_Connection *c, unsigned status_code, const char *code, const char *words)
{
    return answer_refusal(c, status_code, code, words, NULL);
}

enum MHD_Result answer_no_method(struct MHD_Connection *c, const char *allow)
{
    char words[64];
    snprintf(words, sizeof words, "this takes %s alone", allow);
    return answer_refusal(c, MHD_HTTP_METHOD_NOT_ALLOWED, "no_method", words, allow);
}

static const char *type_of(const char *name)
{
    static const char *const types[][2] = {
        {".html", "text/html; charset=utf-8"}, {".png", "image/png"},  {".json", "application/json"},
        {".glb", "model/gltf-binary"},         {".txt", "text/plain"}, {".zip", "application/zip"},
    };
    for (size_t i = 0; i < sizeof types / sizeof *types; i++)
        if (file_ends_in(name, types[i][0])) return types[i][1];
    return "application/octet-stream";
}

enum MHD_Result answer_file(struct MHD_Connection *c, int descriptor, uint64_t bytes, const char *name)
{
    char disposition[256];
    const char *type = type_of(name);
    const bool shown = strncmp(type, "text/html", 9) == 0 || strcmp(type, "image/png") == 0;
    snprintf(disposition, sizeof disposition, "%s; filename=\"%.128s\"", shown ? "inline" : "attachment", name);
    struct MHD_Response *r = http()->create_response_from_fd64(bytes, descriptor);
    if (!r) close(descriptor);
    if (r) put(r, "Content-Disposition", disposition);
    return send_with(c, MHD_HTTP_OK, r, type, RESULT_POLICY);
}

enum MHD_Result answer_text(struct MHD_Connection *c, const char *type, const char *text, const char *csp)
{
    struct MHD_Response *r = http()->create_response_from_buffer(strlen(text), (void *)text, MHD_RESPMEM_PERSISTENT);
    return send_with(c, MHD_HTTP_OK, r, type, csp ? csp : NO_POLICY);
}

enum MHD_Result answer_nothing(struct MHD_Connection *c)
{
    struct MHD_Response *r = http()->create_response_from_buffer(0, NULL, MHD_RESPMEM_PERSISTENT);
    return send_with(c, MHD_HTTP_NO_CONTENT, r, "text/plain", NO_POLICY);
}

enum MHD_Result answer_signed_in(struct MHD_Connection *c, const char *cookie)
{
    struct MHD_Response *r = http()->create_response_from_buffer(0, NULL, MHD_RESPMEM_PERSISTENT);
    if (r) put(r, "Set-Cookie", cookie);
    if (r) put(r, "Location", "/");
    return send_with(c, MHD_HTTP_SEE_OTHER, r, "text/plain", NO_POLICY);
}
