/* SPDX-License-Identifier: MIT */
#include "view/view_scene.h"

#include <cjson/cJSON.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/json/json_put.h"
#include "estimate/light/found_light.h"
#include "optics/camera.h"

static cJSON *list_of(const float *values, int count)
{
    cJSON *list = cJSON_CreateArray();
    for (int i = 0; i < count; i++)
        json_append(list, cJSON_CreateNumber((double)values[i]));
    return list;
}

static void put_list(cJSON *to, const char *key, const float *values, int count)
{
    json_put_item(to, key, list_of(values, count));
}

static void put_range(cJSON *to, const char *key, view_range r)
{
    put_list(to, key, (const float[]){r.near, r.far}, 2);
}

static void put_photograph(cJSON *root, const merlin_maps *maps)
{
    cJSON *o = json_put_object(root, "photograph");
    json_put_number(o, "width", maps->mask.width);
    json_put_number(o, "height", maps->mask.height);
    json_put_number(o, "side", maps->crop.side);
}

static void put_camera(cJSON *root, const surface *s)
{
    const camera_lens lens = surface_lens(s);
    json_put_number(root, "tangent", (double)camera_tangent(lens.fov));
    put_list(root, "slant", (const float[]){lens.slant.right, lens.slant.up}, 2);
}

static void put_occluder(cJSON *root, const shadow_occluder *c, view_range range)
{
    cJSON *o = json_put_object(root, "caster");
    json_put_number(o, "side", c->depth.width);
    put_range(o, "depth", range);
    json_put_number(o, "nearest", (double)c->nearest);
    json_put_number(o, "farthest", (double)c->farthest);
}

static void put_lamp(cJSON *list, const lamp *l, bool fixed)
{
    cJSON *o = json_append_object(list);
    put_list(o, "at", (const float[]){l->at.x, l->at.y, l->at.z}, 3);
    put_list(o, "tint", (const float[]){l->tint.x, l->tint.y, l->tint.z}, 3);
    json_put_bool(o, "distant", l->distant);
    json_put_bool(o, "fixed", fixed);
}

/* Adds the light estimated from the photograph, null if nothing is known. */
static void put_light(cJSON *root, const merlin_found_light *light)
{
    found_lights found;
    const status s = light->known ? found_light_stand(light, 0, &found) : MERLIN_BAD_INPUT;
    if (s != OK) {
        json_put_item(root, "light", s == MERLIN_NO_MEMORY ? NULL : cJSON_CreateNull());
        return;
    }
    cJSON *o = json_put_object(root, "light"), *lamps = json_put_array(o, "lamps");
    cJSON *rest = json_put_array(o, "rest");
    for (int i = 0; i < found.count; i++)
        put_lamp(lamps, &found.lamps[i], i < found.fixed);
    for (int i = 0; i < 9; i++)
        json_append(rest, list_of(light->rest[i], 3));
    env_map_free(&found.rest);
}

static void put_all(cJSON *root, const merlin_maps *maps, const merlin_view_params *params, const relighter *s,
                    const view_ranges *ranges, float white)
{
    json_put_text(root, "name", params->name ? params->name : "object");
    json_put_text(root, "folder", params->folder ? params->folder : "FOLDER");
    json_put_number(root, "side", s->full.mask.width);
    json_put_number(root, "low", s->low.mask.width);
    put_photograph(root, maps);
    put_camera(root, &s->full);
    json_put_bool(root, "matte", s->full.matte);
    json_put_bool(root, "metered", maps->captured != 0);
    json_put_number(root, "white", (double)white);
    json_put_number(root, "ev", log2((double)s->white / (double)white));
    put_range(root, "depth", ranges->covered);
    put_range(root, "object", ranges->object);
    put_occluder(root, &s->occluder, ranges->occluder);
    put_light(root, &maps->light);
}

/* Replaces the characters that would end the HTML element by escapes of JSON. */
static char *without_tags(const char *text)
{
    size_t longer = 0;
    for (const char *c = text; *c; c++)
        longer += *c == '<' ? 5 : 0;
    char *out = malloc(strlen(text) + longer + 1), *to = out;
    for (const char *c = text; out && *c; c++) {
        if (*c == '<') {
            memcpy(to, "\\u003c", 6);
            to += 6;
        } else {
            *to++ = *c;
        }
    }
    if (out) *to = 0;
    return out;
}

status view_scene_text(const merlin_maps *maps, const merlin_view_params *params, const relighter *s,
                       const view_ranges *ranges, float white, char **text)
{
    cJSON *root = cJSON_CreateObject();
    put_all(root, maps, params, s, ranges, white);
    char *printed = json_print_line(root);
    *text = printed ? without_tags(printed) : NULL;
    free(printed);
    cJSON_Delete(root);
    return *text ? OK : fail(MERLIN_NO_MEMORY, "no memory to describe the maps");
}
