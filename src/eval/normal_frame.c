#include "eval/normal_frame.h"

#include <math.h>

#include "stereo/field_fit.h"

static const double DEGREES = 57.29577951308232;

static vec3 sight(const pst_camera *camera, int x, int y)
{
    return camera->perspective ? vec3_normalize(pst_ray(camera, x, y)) : vec3_make(0, 0, -1);
}

/* v turned by the least rotation that takes unit a to unit b (Rodrigues' formula; a and b are not opposite). */
static vec3 turn(vec3 v, vec3 a, vec3 b)
{
    vec3 axis = vec3_cross(a, b), once = vec3_cross(axis, v);
    return vec3_fma(vec3_add(v, once), 1 / (1 + vec3_dot(a, b)), vec3_cross(axis, once));
}

void normal_frame_change(img *normal, const pst_camera *from, const pst_camera *to)
{
    for (int y = 0; y < normal->height; y++)
        for (int x = 0; x < normal->width; x++) {
            float *n = img_at(normal, x, y);
            vec3 turned = turn(vec3_of(n), sight(from, x, y), sight(to, x, y));
            vec3_put(turned, n);
        }
}

double normal_mean_angle(const img *normal, const pst_capture *c, size_t *pixels)
{
    double sum = 0;
    size_t count = 0;
    for (size_t i = 0, total = (size_t)c->width * (size_t)c->height; i < total; i++) {
        const float *n = normal->data + 3 * i, *t = c->normal_true.data + 3 * i;
        vec3 a = vec3_of(n), b = vec3_of(t);
        if (c->mask.data[i] <= 0.5f || vec3_length(b) < 0.5f) continue;
        sum += DEGREES * atan2((double)vec3_length(vec3_cross(a, b)), (double)vec3_dot(a, b));
        count++;
    }
    if (pixels) *pixels = count;
    return count ? sum / (double)count : 0;
}
