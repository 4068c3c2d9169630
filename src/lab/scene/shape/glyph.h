/* SPDX-License-Identifier: MIT */
/* Lettering in an invented alphabet: lines of words whose letters are strokes on a small lattice. */
#ifndef MERLIN_LAB_SCENE_SHAPE_GLYPH_H
#define MERLIN_LAB_SCENE_SHAPE_GLYPH_H

#include <stdint.h>

/* Returns the ink at (x, y), where one letter is a unit wide and a line of text a unit high: 1 on a stroke, 0 beside
 * it, continuous in between; weight is a stroke's half width, 0.05 to 0.15. */
float glyph_ink(float x, float y, float weight, uint32_t seed);

#endif
