/* Lists of light positions from text: `x y z` a line in camera space, or the RTI world's .lp.
 *
 *     light_list lights;
 *     status s = light_list_read("dome.lp", &lights);
 *     for (size_t i = 0; i < lights.count; i++) use(lights.at[i]);
 *     light_list_free(&lights);
 *
 * An .lp file starts with a line that holds one number, the count; then `name x y z` a line, the name as it stands,
 * blanks and all, and the last three being the direction to a distant light, x right, y up, z toward the camera. Such a
 * direction becomes the position at distance 1 from (0, 0, -1), where the object stands: the frontal hemisphere of
 * docs/conventions.md; light_list_direction takes it back, and light_list_written the numbers themselves. Blanks or
 * commas part the numbers, which may have a decimal comma where only blanks do. Empty lines and what follows a # (at
 * the beginning of a line or behind a blank) are skipped. */
#ifndef MERLIN_BASE_LIGHT_LIST_H
#define MERLIN_BASE_LIGHT_LIST_H

#include <stddef.h>

#include "base/status.h"
#include "base/vec.h"

enum { LIGHT_LIST_MAX = 4096 };

typedef struct light_list {
    vec3 *at;
    char **name;  /* of an .lp file: the picture each light belongs to; NULL for a plain list */
    real *length; /* of an .lp file: how long each direction was; NULL for a plain list */
    size_t count;
} light_list;

/* Refuses values that are no numbers, not finite or beyond ±1e6, a count that does not fit, no lights and more than
 * LIGHT_LIST_MAX; messages carry the line's number. */
status light_list_read(const char *path, light_list *out);
/* The same from bytes (need not end in a zero); `where` is put in front of messages. */
status light_list_parse(const char *text, size_t size, const char *where, light_list *out);
/* One more light without a name; for lights named on a command line. */
status light_list_add(light_list *list, vec3 light);
void light_list_free(light_list *list);

/* The unit direction that entry i of an .lp file held. */
static inline vec3 light_list_direction(const light_list *list, size_t i)
{
    return vec3_normalize(vec3_add(list->at[i], vec3_make(0, 0, 1)));
}

/* What stood in the line of entry i of an .lp file: of some near lights it is their position. */
static inline vec3 light_list_written(const light_list *list, size_t i)
{
    return vec3_scale(light_list_direction(list, i), list->length[i]);
}

#endif
