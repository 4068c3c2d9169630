/* SPDX-License-Identifier: MIT */
/* merlin serve: a page and an HTTP interface. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/json/json_put.h"
#include "base/text/report.h"
#include "cli/commands.h"
#include "command/cli.h"
#include "command/json_line.h"
#include "command/options.h"
#include "command/photos.h"
#include "serve/serve.h"

static const char help[] =
    "usage: merlin serve [options]\n\n"
    "A page on this machine, into which one drops photographs, corrects the mask by a brush, and gets the maps, their\n"
    "viewer and all files; and the same as an HTTP interface, described by /v1/openapi.json. One job works at a time,\n"
    "others wait. Ends by Ctrl-C, and leaves nothing.\n\n"
    "  -p, --port N         where (default 8712); 0: any that is free\n"
    "      --host ADDRESS   for other machines, too: the address they reach this one at, or 0.0.0.0 for all of its\n"
    "                       addresses; clients then need the token, which is made up unless --token gives it\n"
    "      --name NAME      with --host, a name by which clients call this machine; may be given again\n"
    "      --token FILE     a file whose first line, of 16 to 128 letters, digits, dashes and underscores, clients\n"
    "                       send as their token\n"
    "      --model W        weights: merlin-any, merlin-point, merlin-env, or a file (default: $MERLIN_MODEL, else\n"
    "                       merlin-any with merlin-point)\n"
    "      --keep MIN       minutes for which results stay (default 30)\n"
    "      --waiting N      most jobs that wait (default 32); others are refused\n"
    "      --results N      most results that stay (default 100); the oldest go first\n"
    "      --room MB        megabytes that they may have together (default 4096); likewise\n"
    "      --upload MB      megabytes that a request may have (default 256)\n"
    "      --megapixels N   of a photograph, at most (default 50)\n"
    "      --json           a report as JSON on standard output when it is ready\n"
    "  -t, --threads N      how many threads work (default: one a processor)\n"
    "  -q, --quiet          no other output than errors\n"
    "  -h, --help           this text\n\n"
    "What is uploaded lies in a folder of $TMPDIR (or /tmp) that is open to its owner alone.\n";

typedef struct request {
    serve_params params;
    const char *model_name, *token_file;
    int name_count;
    char token[129];
    bool json, quiet, help;
} request;

static status take_name(const char *value, void *into)
{
    request *r = into;
    if (!*value || strpbrk(value, "/:@ "))
        return fail(MERLIN_WRONG_USE, "--name wants a host's name, not \"%s\"", value);
    if (r->name_count >= GUARD_MOST_NAMES - 1)
        return fail(MERLIN_WRONG_USE, "--name may be given %d times", GUARD_MOST_NAMES - 1);
    r->params.names[r->name_count++] = value;
    return OK;
}

static status read_token(request *r)
{
    enum { MOST = 4096 };
    char *text = NULL;
    size_t size;
    status s = file_read(r->token_file, MOST, &text, &size);
    if (s != OK) return s;
    const size_t length = strcspn(text, "\r\n");
    text[length] = 0;
    const bool plain = strspn(text, "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_") == length;
    if (length < GUARD_LEAST_TOKEN || length >= sizeof r->token || !plain)
        s = fail(MERLIN_BAD_INPUT,
                 "--token %s: its first line must be 16 to 128 letters, digits, dashes and underscores", r->token_file);
    else
        memcpy(r->token, text, length + 1);
    free(text);
    r->params.token = r->token;
    return s;
}

static status parse(int *argc, char ***argv, request *r)
{
    serve_params *p = &r->params;
    const cli_option options[] = {
        {"port", 'p', .integer = &p->port, .low = 0, .high = 65535},
        {"host", .text = &p->host},
        {"name", .take = take_name, .into = r, .many = true},
        {"token", .text = &r->token_file},
        {"model", .text = &r->model_name},
        {"keep", .integer = &p->keep_minutes, .low = 1, .high = 7 * 24 * 60},
        {"waiting", .integer = &p->most_waiting, .low = 1, .high = 1000},
        {"results", .integer = &p->most_kept, .low = 1, .high = 10000},
        {"room", .integer = &p->kept_megabytes, .low = 1, .high = 1 << 20},
        {"upload", .integer = &p->upload_megabytes, .low = 1, .high = 1 << 16},
        {"megapixels", .integer = &p->megapixels, .low = 1, .high = 64},
        {"json", .flag = &r->json},
        {"quiet", 'q', .flag = &r->quiet},
        {"help", 'h', .flag = &r->help},
        {0},
    };
    status s = cli_read_options(argc, argv, options);
    if (s != OK || r->help) return s;
    if (*argc) return fail(MERLIN_WRONG_USE, "nothing is expected beside options, not %s", (*argv)[0]);
    if (r->name_count && !p->host) return fail(MERLIN_WRONG_USE, "--name goes with --host");
    return r->token_file ? read_token(r) : OK;
}

static status announce(const request *r, const serve *server)
{
    status s = OK;
    if (r->json) {
        cJSON *report = report_begin(NULL);
        json_put_text(report, "address", serve_address(server, 0));
        cJSON *all = json_put_array(report, "addresses");
        for (int i = 0; serve_address(server, i); i++)
            json_append_text(all, serve_address(server, i));
        s = json_line_print(report);
        cJSON_Delete(report);
    } else if (!r->quiet) {
        printf("merlin serves at %s (Ctrl-C ends it)\n", serve_address(server, 0));
        for (int i = 1; serve_address(server, i); i++)
            printf("              or %s\n", serve_address(server, i));
    }
    return fflush(stdout) == 0 ? s : fail(MERLIN_CANNOT_WRITE, "cannot write to standard output");
}

/* Prepares the network before the first photograph arrives. */
static status open_models(const request *r, merlin_model **model, merlin_near_network **near)
{
    char *weights = NULL, *flash = NULL;
    const merlin_params params = merlin_params_default();
    status s = photo_find_models(r->model_name, &weights, &flash);
    if (s == OK) s = photo_open_models(weights, flash, model);
    if (s == OK) s = photo_add_several(flash, *model);
    if (s == OK) s = photo_open_near(NULL, false, near);
    if (s == OK) s = merlin_model_prepare(*model, &params);
    free(weights);
    free(flash);
    return s;
}

int cmd_serve(int argc, char **argv)
{
    request r = {.params = {.port = 8712,
                            .keep_minutes = 30,
                            .most_waiting = 32,
                            .most_kept = 100,
                            .kept_megabytes = 4096,
                            .upload_megabytes = 256,
                            .megapixels = 50}};
    serve *server = NULL;
    merlin_near_network *near = NULL;
    status s = parse(&argc, &argv, &r);
    if (s != OK) return cli_refuse("serve", s);
    if (r.help) return fputs(help, stdout) < 0;
    cli_catch_interrupts();
    s = open_models(&r, &r.params.model, &near);
    r.params.near = near;
    if (s == OK) s = serve_open(&r.params, &server);
    if (s == OK) s = announce(&r, server);
    if (s == OK) serve_run(server, cli_interrupted);
    serve_close(server);
    merlin_model_close(r.params.model);
    merlin_near_network_close(near);
    return s == OK ? 0 : cli_fail("serve", s);
}
