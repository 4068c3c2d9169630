/* SPDX-License-Identifier: MIT */
#include "serve/store/safe_name.h"

#include <stdbool.h>
#include <stdio.h>
#include <string.h>

/* Length reserved for a number, and length of the end of a long name that is kept. */
enum { FOR_NUMBER = 12, END = 32 };

static bool is_harmless(unsigned char c)
{
    return c >= 0x80 || (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') ||
           strchr("._- ", c) != NULL;
}

void safe_name(const char *given, char name[SAFE_NAME])
{
    const size_t most = SAFE_NAME - 1 - FOR_NUMBER;
    for (const char *c = given; *c; c++)
        if (*c == '/' || *c == '\\') given = c + 1;
    given += strspn(given, ". ");
    const size_t length = strlen(given);
    if (length > most)
        snprintf(name, SAFE_NAME, "%.*s%s", (int)(most - END), given, given + length - END);
    else
        snprintf(name, SAFE_NAME, "%s", length ? given : "file");
    for (char *c = name; *c; c++)
        if (!is_harmless((unsigned char)*c)) *c = '_';
}

void safe_name_number(char name[SAFE_NAME], size_t number)
{
    char old[SAFE_NAME];
    memcpy(old, name, sizeof old);
    const char *dot = strrchr(old, '.');
    const size_t length = strlen(old), stem = dot ? (size_t)(dot - old) : length;
    const size_t ending = length - stem < END ? length - stem : END, most = SAFE_NAME - 1 - FOR_NUMBER - ending;
    snprintf(name, SAFE_NAME, "%.*s_%zu%.*s", (int)(stem < most ? stem : most), old, number, (int)ending, old + stem);
}
