/* SPDX-License-Identifier: MIT */
/* JSON objects from arbitrary bytes, asked for keys of every type: whatever is accepted must be within its range. */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "base/text/json.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void ask(json_object *o)
{
    static const char *const words[] = {"one", "two"};
    char text[8], *inner = NULL;
    int whole = 0, several[3] = {0}, word = 0;
    double number = 0;
    bool truth;
    if (json_int(o, "int", -5, 5, &whole) == OK && abs(whole) > 5) abort();
    if (json_number_or(o, "number", -1, 1, 0.5, &number) == OK && !(fabs(number) <= 1)) abort();
    if (json_text(o, "text", text, sizeof text) == OK && strlen(text) >= sizeof text) abort();
    if (json_choice(o, "choice", words, 2, &word) == OK && word != 0 && word != 1) abort();
    if (json_ints_or(o, "ints", 0, 9, 3, 1, several) == OK)
        for (int i = 0; i < 3; i++)
            if (several[i] < 0 || several[i] > 9) abort();
    if (json_inner(o, "inner", &inner) == OK) {
        json_object *below;
        if (json_parse(inner, strlen(inner), "fuzz", &below) == OK) json_free(below);
        free(inner);
    }
    (void)json_bool(o, "bool", &truth);
    (void)json_finish(o);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    json_object *o;
    if (json_parse((const char *)data, size, "fuzz", &o) == OK) {
        ask(o);
        json_free(o);
    }
    return 0;
}
