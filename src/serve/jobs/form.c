/* SPDX-License-Identifier: MIT */
#include "serve/jobs/form.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/text/text_number.h"

/* ---- fields ---- */

/* Returns room for one more of `count` items that are kept in blocks; NULL without memory. */
static void *grown(void *items, size_t count, size_t size)
{
    enum { BLOCK = 16 };
    return count % BLOCK ? items : realloc(items, (count + BLOCK) * size);
}

form_field *form_add_field(form *f, const char *key)
{
    form_field *fields = grown(f->fields, f->field_count, sizeof *fields);
    if (!fields) return NULL;
    f->fields = fields;
    form_field *added = &fields[f->field_count++];
    snprintf(added->key, sizeof added->key, "%s", key);
    *added->value = 0;
    return added;
}

static bool is_taken(const form *f, const char *name)
{
    for (size_t i = 0; i < f->file_count; i++)
        if (strcmp(f->files[i].name, name) == 0) return true;
    return false;
}

form_file *form_add_file(form *f, const char *key, const char *given_name)
{
    form_file *files = grown(f->files, f->file_count, sizeof *files), added = {.bytes = 0};
    if (!files) return NULL;
    f->files = files;
    snprintf(added.key, sizeof added.key, "%s", key);
    safe_name(given_name, added.name);
    for (size_t number = f->file_count + 1; is_taken(f, added.name); number++) {
        safe_name(given_name, added.name);
        safe_name_number(added.name, number);
    }
    files[f->file_count] = added;
    return &files[f->file_count++];
}

void form_free(form *f)
{
    free(f->fields);
    free(f->files);
    *f = (form){.bytes = 0};
}

/* ---- checks ---- */

static const form_key *find_key(const form_key *known, const char *name)
{
    for (; known->name; known++)
        if (strcmp(known->name, name) == 0) return known;
    return NULL;
}

static status check_key(const char *name, form_kind kind, const char *what, const form_key *known)
{
    const form_key *key = find_key(known, name);
    if (key && key->kind == kind) return OK;
    if (key)
        return fail(MERLIN_WRONG_USE, "%s of %s is %s", name, what,
                    kind == FORM_FILE ? "a value, not a file" : "a file: its part needs a filename");
    char list[512] = "";
    for (const form_key *k = known; k->name; k++) {
        size_t length = strlen(list);
        snprintf(list + length, sizeof list - length, "%s%s", length ? ", " : "", k->name);
    }
    return fail(MERLIN_WRONG_USE, "%s knows no field \"%s\": it has %s", what, name, list);
}

status form_check(const form *f, const char *what, const form_key *known)
{
    status s = OK;
    for (size_t i = 0; i < f->field_count && s == OK; i++)
        s = check_key(f->fields[i].key, FORM_VALUE, what, known);
    for (size_t i = 0; i < f->file_count && s == OK; i++)
        s = check_key(f->files[i].key, FORM_FILE, what, known);
    for (const form_key *k = known; k->name && s == OK; k++) {
        size_t count = 0;
        for (size_t i = 0; i < f->field_count; i++)
            count += strcmp(f->fields[i].key, k->name) == 0;
        for (size_t i = 0; i < f->file_count; i++)
            count += strcmp(f->files[i].key, k->name) == 0;
        if (count > k->most)
            s = fail(MERLIN_WRONG_USE, "%s is given %zu times, and %s takes %zu at most", k->name, count, what,
                     k->most);
    }
    return s;
}

/* ---- values ---- */

const char *form_value_at(const form *f, const char *key, size_t index)
{
    for (size_t i = 0; i < f->field_count; i++)
        if (strcmp(f->fields[i].key, key) == 0 && index-- == 0) return f->fields[i].value;
    return NULL;
}

const char *form_value(const form *f, const char *key)
{
    return form_value_at(f, key, 0);
}

const form_file *form_find_file(const form *f, const char *key)
{
    for (size_t i = 0; i < f->file_count; i++)
        if (strcmp(f->files[i].key, key) == 0) return &f->files[i];
    return NULL;
}

static bool read_number(const char *text, size_t length, double low, double high, double *out)
{
    return text_number(text, length, false, out) == TEXT_NUMBER && *out >= low && *out <= high;
}

status form_real(const form *f, const char *key, double low, double high, float *out)
{
    const char *text = form_value(f, key);
    double value = 0;
    if (!text) return OK;
    if (!read_number(text, strlen(text), low, high, &value))
        return fail(MERLIN_WRONG_USE, "%s wants a number from %g to %g, not \"%s\"", key, low, high, text);
    *out = (float)value;
    return OK;
}

status form_integer(const form *f, const char *key, int low, int high, int *out)
{
    const char *text = form_value(f, key);
    double value = 0;
    if (!text) return OK;
    if (!read_number(text, strlen(text), low, high, &value) || value != floor(value))
        return fail(MERLIN_WRONG_USE, "%s wants a whole number from %d to %d, not \"%s\"", key, low, high, text);
    *out = (int)value;
    return OK;
}

status form_choice(const form *f, const char *key, const char *const *words, int count, int *out)
{
    const char *text = form_value(f, key);
    char list[256] = "";
    for (int i = 0; text && i < count; i++) {
        size_t length = strlen(list);
        snprintf(list + length, sizeof list - length, "%s%s", i ? ", " : "", words[i]);
        if (strcmp(text, words[i]) != 0) continue;
        *out = i;
        return OK;
    }
    return text ? fail(MERLIN_WRONG_USE, "%s wants one of %s, not \"%s\"", key, list, text) : OK;
}

status form_flag(const form *f, const char *key, int *out)
{
    static const char *const words[] = {"0", "1", "false", "true", "no", "yes", "off", "on"};
    int which = *out ? 1 : 0;
    status s = form_choice(f, key, words, sizeof words / sizeof *words, &which);
    *out = which % 2;
    return s;
}

status form_numbers(const form *f, const char *key, size_t index, double low, double high, int count, float *out)
{
    const char *text = form_value_at(f, key, index), *at = text;
    for (int i = 0; text && i < count; i++) {
        const size_t length = strcspn(at, ",");
        double value = 0;
        if (!read_number(at, length, low, high, &value) || (at[length] == ',') != (i < count - 1)) {
            at = NULL;
            break;
        }
        out[i] = (float)value;
        at += length + (at[length] == ',');
    }
    if (text && at) return OK;
    return fail(MERLIN_WRONG_USE, "%s wants %d numbers from %g to %g with commas between them, not \"%s\"", key, count,
                low, high, text ? text : "");
}
