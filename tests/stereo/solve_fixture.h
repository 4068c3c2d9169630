/* SPDX-License-Identifier: MIT */
/* Captures of a relief under distant lights, for the tests of solvers. */
#ifndef MERLIN_TESTS_STEREO_SOLVE_FIXTURE_H
#define MERLIN_TESTS_STEREO_SOLVE_FIXTURE_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include "base/status.h"

#include <cmocka.h> /* last, as cmocka defines a macro named fail */

#include "relief.h"
#include "stereo/algebra/matrix3.h"
#include "stereo/fit/pixel_fit.h"
#include "stereo/methods/solve.h"

static const relief lambert = {.size = 48, .lights = 24, .channels = 1, .exposure = 1.8f};
static const relief glossy = {.size = 64,
                              .lights = 50,
                              .channels = 3,
                              .bump = 5,
                              .specular = 4,
                              .roughness = 0.35f,
                              .exposure = 0.3f,
                              .cast_shadows = true};

#endif
