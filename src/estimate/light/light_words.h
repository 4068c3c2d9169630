/* SPDX-License-Identifier: MIT */
/* The light that a photograph is lit by, in words for a person.
 *
 *     char words[LIGHT_WORDS];
 *     light_words(&maps.light, words);      "a lamp from the upper left, 40 degrees aside, in a room"
 */
#ifndef MERLIN_ESTIMATE_LIGHT_LIGHT_WORDS_H
#define MERLIN_ESTIMATE_LIGHT_LIGHT_WORDS_H

#include "base/api_needs.h"
#include "merlin/merlin.h"

enum { LIGHT_WORDS = 128 };

/* Names what sends a seventh of the light or more; "" where nothing is known. */
void light_words(const merlin_found_light *light, char words[LIGHT_WORDS]);

#endif
