// SPDX-License-Identifier: MIT
// The picture under lamps and a room, exposed: linear, in a target that encodes it.
uniform sampler2D seen_0, seen_1, seen_2, seen_3; // of each lamp, how much of it is seen
uniform sampler2D room;                           // radiance of the room's light
uniform vec3 room_scale;
uniform float white;
uniform bool plain; // the shape alone: one colour, no gloss
in vec2 place;
out vec4 color;

const vec3 CLAY = vec3(0.5);

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    surface s = surface_at(pixel);
    if (s.coverage == 0.0) {
        color = vec4(0);
        return;
    }
    if (plain) s.albedo = CLAY;
    vec3 ray = camera_ray(place), point = ray * s.depth, v = -normalize(ray);
    vec3 sum = vec3(0);
    for (int i = 0; i < lamp_count; i++) {
        float seen = i == 0   ? texture(seen_0, place).r
                     : i == 1 ? texture(seen_1, place).r
                     : i == 2 ? texture(seen_2, place).r
                              : texture(seen_3, place).r;
        sum += seen * lamp_radiance(i, s, point, v);
    }
    vec3 radiance = s.coverage * sum + texture(room, place).rgb * room_scale;
    color = vec4(clamp(radiance / white, 0.0, 1.0), s.coverage);
}
