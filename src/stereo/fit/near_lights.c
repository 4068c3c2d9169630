/* SPDX-License-Identifier: MIT */
#include "stereo/fit/near_lights.h"

#include <math.h>
#include <stdbool.h>

#include "optics/led.h"

void pst_near_lights_at(const pst_problem *p, vec3 at, pst_near_lights *out)
{
    int count = p->capture->count, padded = pst_padded(count);
    for (int k = 0; k < padded; k++)
        out->x[k] = out->y[k] = out->z[k] = out->power[k] = 0;
    for (int k = 0; k < count; k++) {
        const merlin_light *from = &p->light[k];
        float power;
        vec3 l = led_light_at(vec3_of(from->position), vec3_of(from->direction), from->lobe, at, &power);
        out->x[k] = l.x;
        out->y[k] = l.y;
        out->z[k] = l.z;
        out->power[k] = power;
    }
}

void pst_near_lights_divide(const pst_near_lights *l, int padded, float *value, float *usable)
{
    float most = 0;
    for (int k = 0; k < padded; k++)
        most = l->power[k] > most ? l->power[k] : most;
    for (int k = 0; k < padded; k++) {
        bool lit =
            l->power[k] >
            1e-4f * most; /* less is on the dark side of the LED's lobe, where the division would only amplify noise */
        value[k] = lit ? value[k] / l->power[k] : 0;
        usable[k] = lit ? usable[k] : 0;
    }
}
