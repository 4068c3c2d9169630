/* SPDX-License-Identifier: MIT */
/* A client's form: fields with a value, and files, which are in a folder of the store.
 *
 *     static const form_key known[] = {{"photo", FORM_FILE, 1}, {"size", FORM_VALUE, 1}, {0}};
 *     int size = 512;
 *     status s = form_check(f, "estimate", known);
 *     if (s == OK) s = form_integer(f, "size", 64, 512, &size);
 *
 * Functions that read a value leave the result unchanged if the field is missing. Failures are MERLIN_WRONG_USE and
 * name the field. */
#ifndef MERLIN_SERVE_JOBS_FORM_H
#define MERLIN_SERVE_JOBS_FORM_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/status.h"
#include "serve/store/safe_name.h"
#include "serve/store/store.h"

enum { FORM_KEY = 32, FORM_MOST_VALUE = 1024, FORM_MOST_FIELDS = 128 };

typedef struct form_field {
    char key[FORM_KEY];
    char value[FORM_MOST_VALUE + 1];
} form_field;

typedef struct form_file {
    char key[FORM_KEY];
    char name[SAFE_NAME]; /* name in the folder */
    uint64_t bytes;
} form_file;

typedef struct form {
    char id[STORE_ID]; /* identifier of the folder */
    form_field *fields;
    size_t field_count;
    form_file *files;
    size_t file_count;
    uint64_t bytes; /* size of all files */
} form;

/* Adds an empty field or file, and returns it; NULL without memory. A file's name is made safe and unique. */
form_field *form_add_field(form *f, const char *key);
form_file *form_add_file(form *f, const char *key, const char *given_name);
void form_free(form *f);

typedef enum form_kind { FORM_VALUE, FORM_FILE } form_kind;
typedef struct form_key {
    const char *name;
    form_kind kind;
    size_t most; /* how often it may occur */
} form_key;

/* Refuses unknown fields, too many of one, and fields of the wrong kind. known ends with a zero row. */
status form_check(const form *f, const char *what, const form_key *known);

/* Returns the first value of a field; NULL: none. form_value_at: the index-th. */
const char *form_value(const form *f, const char *key);
const char *form_value_at(const form *f, const char *key, size_t index);
const form_file *form_find_file(const form *f, const char *key);

status form_integer(const form *f, const char *key, int low, int high, int *out);
status form_real(const form *f, const char *key, double low, double high, float *out);
/* Reads "1", "true", "yes", "on"; or "0", "false", "no", "off". */
status form_flag(const form *f, const char *key, int *out);
/* Reads one of `count` words; *out is its index. */
status form_choice(const form *f, const char *key, const char *const *words, int count, int *out);
/* Reads exactly `count` numbers separated by commas, each within [low, high], from the index-th value, which must
 * exist. */
status form_numbers(const form *f, const char *key, size_t index, double low, double high, int count, float *out);

#endif
