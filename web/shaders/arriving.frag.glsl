// SPDX-License-Identifier: MIT
// Which share of a room's irradiance arrives past the surface itself (src/estimate/relight_env.c, shade_seen).
uniform sampler2D low_normal, lights; // lights: direction and solid angle, power
uniform int light_count;
uniform vec2 turn; // the room's, cosine and sine
in vec2 place;
out vec4 share;

vec3 share_of(vec3 part, vec3 whole) {
    return mix(vec3(1), min(part / max(whole, 1e-12), 1.0), step(1e-12, whole));
}

void main() {
    vec4 n = texelFetch(low_normal, ivec2(gl_FragCoord.xy), 0);
    share = vec4(0);
    if (n.w == 0.0) return;
    sky_view v = sky_at(place);
    vec3 seen = vec3(0), all = vec3(0);
    for (int i = 0; i < light_count; i++) {
        vec4 to = texelFetch(lights, ivec2(i, 0), 0);
        vec3 d = vec3(turn.x * to.x - turn.y * to.z, to.y, turn.y * to.x + turn.x * to.z);
        float cosine = dot(n.xyz, d);
        if (!(cosine > 0.0)) continue;
        vec3 power = texelFetch(lights, ivec2(i, 1), 0).rgb * cosine;
        all += power;
        seen += power * sky_seen(v, d, to.w);
    }
    share = vec4(share_of(seen, all), 1.0);
}
