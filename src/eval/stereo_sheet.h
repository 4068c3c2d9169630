/* A picture of what photometric stereo found: a line of tiles an object, its photograph, true and found normals, and
 * where the found ones are off. Internal to the evaluation of stereo.
 *
 *     stereo_sheet *sheet;
 *     status s = stereo_sheet_new(14, &sheet);
 *     if (s == OK) s = stereo_sheet_add(sheet, &object, normals);      again for each object
 *     if (s == OK) s = stereo_sheet_write(sheet, "sheet.png");
 *     stereo_sheet_free(sheet);
 */
#ifndef MERLIN_EVAL_STEREO_SHEET_H
#define MERLIN_EVAL_STEREO_SHEET_H

#include "eval/stereo_object.h"
#include "eval/stereo_table.h"

typedef struct stereo_sheet stereo_sheet;

status stereo_sheet_new(size_t objects, stereo_sheet **out);
void stereo_sheet_free(stereo_sheet *sheet);
/* normal: one a row of the table, of the capture's size; empty where there is no solution. */
status stereo_sheet_add(stereo_sheet *sheet, const stereo_object *o, const img normal[STEREO_ROWS]);
status stereo_sheet_write(const stereo_sheet *sheet, const char *path);

#endif
