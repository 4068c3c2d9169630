/* SPDX-License-Identifier: MIT */
#include "estimate/photo/light_choice.h"

#include "estimate/light/found_light.h"

static status estimate_is_flash(network *any, const light_question *q, bool *is_flash)
{
    float code[MODEL_LIGHTS];
    merlin_found_light light;
    status s = network_lights(any, q->photo, q->mask, q->how, code);
    if (s != OK) return s;
    found_light_take(code, &light);
    *is_flash = found_light_is_flash(&light);
    return OK;
}

status light_choice(network *any, network *flash, const light_question *q, network **out)
{
    bool is_flash = q->how->flash;
    status s = OK;
    if (flash && !is_flash && q->fired != MERLIN_FLASH_NONE) s = estimate_is_flash(any, q, &is_flash);
    *out = flash && is_flash ? flash : any;
    return s;
}
