/* SPDX-License-Identifier: MIT */
#include "serve/http/http_library.h"

#include "base/library.h"

static http_functions functions;
#define WANT(name) {"MHD_" #name, &functions.name},
static const library_function wanted[] = {HTTP_FUNCTIONS(WANT)};
static library microhttpd = {.file = MERLIN_MICROHTTPD, .functions = wanted, .count = sizeof wanted / sizeof *wanted};

status http_load(void)
{
    return library_need(&microhttpd);
}

const http_functions *http(void)
{
    return &functions;
}
