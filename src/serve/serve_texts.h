/* SPDX-License-Identifier: MIT */
/* Texts that the build makes of web/serve/ and docs/openapi.json: lines, ended by NULL. */
#ifndef MERLIN_SERVE_SERVE_TEXTS_H
#define MERLIN_SERVE_SERVE_TEXTS_H

extern const char *const serve_page[];
extern const char *const serve_openapi[];

#endif
