/* SPDX-License-Identifier: MIT */
/* doubt_table.h's table as text and as JSON. */
#include <cjson/cJSON.h>

#include "base/json/json_put.h"
#include "base/text/report.h"
#include "lab/eval/tables/doubt_table.h"

static const struct {
    const char *words, *key;
    bool right; /* a doubt is a false alarm */
} kinds[DOUBT_KINDS] = {
    [DOUBT_RIGHT_PHOTO] = {"photographs by a flash", "photos_right", true},
    [DOUBT_FLASH] = {"samples by a flash", "flash", true},
    [DOUBT_FLASH_ROOM] = {"samples by a flash in a room", "flash_in_room", true},
    [DOUBT_ROOM] = {"samples in a room", "room", false},
    [DOUBT_LAMP] = {"samples by a lamp at 25 to 50 degrees", "lamp", false},
    [DOUBT_LAMP_FAR] = {"samples by a lamp beyond", "lamp_far", false},
    [DOUBT_WRONG_PHOTO] = {"other photographs", "photos_wrong", false},
};

static void print_codes(unsigned doubts, FILE *stream)
{
    const char *between = "";
    for (unsigned bit = 1; bit <= doubts; bit <<= 1) {
        if (!(doubts & bit)) continue;
        fprintf(stream, "%s%s", between, merlin_doubt_code((merlin_doubt)bit));
        between = ", ";
    }
}

void doubt_table_print(const doubt_table *t, FILE *stream)
{
    for (size_t i = 0; i < t->count; i++) {
        const doubt_row *row = &t->row[i];
        if (row->kind != DOUBT_RIGHT_PHOTO && row->kind != DOUBT_WRONG_PHOTO) continue;
        fprintf(stream, "%-5s %-32.32s %5.2f  ", kinds[row->kind].right ? "right" : "wrong", row->name,
                (double)row->elsewhere);
        print_codes(row->doubts, stream);
        fputc('\n', stream);
    }
    fprintf(stream, "\n%-42s%10s%16s%12s\n", "", "pictures", "light doubted", "any doubt");
    for (int k = 0; k < DOUBT_KINDS; k++) {
        doubt_counts c = doubt_table_count(t, (doubt_kind)k);
        if (c.pictures)
            fprintf(stream, "%-5s %-36s%10zu%14.1f %%%10.1f %%\n", kinds[k].right ? "right" : "wrong", kinds[k].words,
                    c.pictures, 100 * (double)c.light / (double)c.pictures, 100 * (double)c.any / (double)c.pictures);
    }
}

static cJSON *cues_json(const light_cues *c)
{
    cJSON *o = cJSON_CreateObject();
    json_put_bool(o, "known", c->known);
    json_put_number(o, "fall", c->fall);
    json_put_number(o, "tilt", c->tilt);
    json_put_number(o, "rest", c->rest);
    json_put_number(o, "black", c->black);
    json_put_number(o, "outward", c->outward);
    json_put_number(o, "inward", c->inward);
    json_put_number(o, "rise", c->rise);
    return o;
}

static cJSON *row_json(const doubt_row *row)
{
    cJSON *o = cJSON_CreateObject();
    json_put_text(o, "name", row->name);
    json_put_text(o, "kind", kinds[row->kind].key);
    json_put_number(o, "light_elsewhere", row->elsewhere);
    cJSON *doubts = json_put_array(o, "doubts");
    for (unsigned bit = 1; bit <= row->doubts; bit <<= 1)
        if (row->doubts & bit) json_append_text(doubts, merlin_doubt_code((merlin_doubt)bit));
    json_put_item(o, "cues", cues_json(&row->cues));
    return o;
}

char *doubt_table_json(const doubt_table *t)
{
    cJSON *root = report_begin(&(warnings){0});
    cJSON *counts = json_put_object(root, "counts"), *list = json_put_array(root, "pictures");
    for (int k = 0; k < DOUBT_KINDS; k++) {
        doubt_counts c = doubt_table_count(t, (doubt_kind)k);
        if (!c.pictures) continue;
        cJSON *o = json_put_object(counts, kinds[k].key);
        json_put_bool(o, "right", kinds[k].right);
        json_put_number(o, "pictures", (double)c.pictures);
        json_put_number(o, "light_doubted", (double)c.light);
        json_put_number(o, "any_doubt", (double)c.any);
    }
    for (size_t i = 0; i < t->count; i++)
        json_append(list, row_json(&t->row[i]));
    char *text = json_print_line(root);
    cJSON_Delete(root);
    return text;
}
