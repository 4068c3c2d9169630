// SPDX-License-Identifier: MIT
// The surface at the size for which it is worked out what of a room's light arrives: means of what is covered.
uniform float step_size; // pixels of the picture a pixel here
in vec2 place;
layout(location = 0) out vec4 low_albedo; // and 1 on the surface
layout(location = 1) out vec4 low_normal;

void main() {
    ivec2 size = textureSize(shape, 0);
    vec2 first = floor(gl_FragCoord.xy) * step_size, end = first + step_size;
    vec3 albedo = vec3(0), normal = vec3(0);
    float covered = 0.0, all = 0.0;
    for (int y = int(first.y); float(y) < end.y && y < size.y; y++)
        for (int x = int(first.x); float(x) < end.x && x < size.x; x++) {
            surface s = surface_at(ivec2(x, y));
            float w = (min(float(x) + 1.0, end.x) - max(float(x), first.x)) *
                      (min(float(y) + 1.0, end.y) - max(float(y), first.y));
            all += w;
            covered += w * s.coverage;
            albedo += w * s.coverage * s.albedo;
            normal += w * s.coverage * s.normal;
        }
    bool on = covered >= 0.5 * all;
    low_albedo = on ? vec4(albedo / covered, 1.0) : vec4(0);
    low_normal = on ? vec4(normalize(normal), 1.0) : vec4(0);
}
