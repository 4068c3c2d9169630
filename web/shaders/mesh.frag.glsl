// SPDX-License-Identifier: MIT
// The turned surface under the same light, or with a map on it.
uniform sampler2D seen_0, seen_1, seen_2, seen_3, room, picture;
uniform vec3 room_scale, eye;
uniform float white;
uniform bool plain, painted; // painted: by the picture
in vec2 place;
in vec3 point;
out vec4 color;

const vec3 CLAY = vec3(0.5), BACK = vec3(0.012);

void main() {
    surface s = surface_between(place);
    vec4 paint = texture(picture, place);
    float cover = clamp((s.coverage - 0.5) / max(fwidth(s.coverage), 1e-4) + 0.5, 0.0, 1.0);
    if (cover == 0.0) discard;
    if (painted || !gl_FrontFacing) {
        color = vec4(srgb_encode(gl_FrontFacing ? paint.rgb / max(paint.a, 0.01) : BACK), cover);
        return;
    }
    if (plain) s.albedo = CLAY;
    vec3 v = normalize(eye - point), sum = vec3(0);
    for (int i = 0; i < lamp_count; i++) {
        float seen = i == 0   ? texture(seen_0, place).r
                     : i == 1 ? texture(seen_1, place).r
                     : i == 2 ? texture(seen_2, place).r
                              : texture(seen_3, place).r;
        sum += seen * lamp_radiance(i, s, point, v);
    }
    sum += texture(room, place).rgb * room_scale / s.coverage;
    color = vec4(srgb_encode(sum / white), cover);
}
