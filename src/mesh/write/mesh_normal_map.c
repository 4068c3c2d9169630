/* SPDX-License-Identifier: MIT */
#include "mesh/write/mesh_normal_map.h"

vec3 mesh_tangent_of(vec3 n)
{
    vec3 t = vec3_normalize(vec3_make(1 - n.x * n.x, -n.x * n.y, -n.x * n.z));
    return vec3_dot(t, t) > (real)0.5 ? t : vec3_make(0, 0, -1);
}

status mesh_normal_map(const merlin_mesh *m, img *out)
{
    status s = img_new(out, m->width, m->height, 3);
    if (s != OK) return s;
    for (size_t i = 0; i < img_value_count(out); i += 3) {
        out->data[i] = out->data[i + 1] = 0.5f;
        out->data[i + 2] = 1;
    }
    for (size_t v = 0; v < m->vertex_count; v++) {
        vec3 n = vec3_of(mesh_base_normals(m) + 3 * v), t = mesh_tangent_of(n), b = vec3_cross(n, t);
        vec3 wanted = vec3_of(m->normals + 3 * v);
        float *to = out->data + 3 * (size_t)m->pixels[v];
        to[0] = 0.5f * (float)vec3_dot(wanted, t) + 0.5f;
        to[1] = 0.5f * (float)vec3_dot(wanted, b) + 0.5f;
        to[2] = 0.5f * (float)vec3_dot(wanted, n) + 0.5f;
    }
    return OK;
}
