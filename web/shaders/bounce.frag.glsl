// SPDX-License-Identifier: MIT
// From where a surface hides a room it sends light itself (src/estimate/relight_env.c, add_bounce); off the surface the
// share goes on smoothly.
uniform sampler2D share, low_normal, sums;
out vec4 arriving;

const int REACH = 4;

vec4 share_with_bounce(ivec2 at) {
    vec4 n = texelFetch(low_normal, at, 0);
    if (n.w == 0.0) return vec4(0);
    vec3 s = texelFetch(share, at, 0).rgb, open = sh_irradiance(n.xyz);
    vec4 sum = texelFetch(sums, at, 0);
    vec3 whole = sum.w * open, part = sum.rgb * 3.14159265358979;
    vec3 back = mix(vec3(1), min(part / max(whole, 1e-12), 1.0), step(1e-12, whole));
    return vec4(s + (1.0 - s) * back, 1.0);
}

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy), size = textureSize(share, 0);
    arriving = share_with_bounce(at);
    if (arriving.w > 0.0) return;
    vec4 around = vec4(0);
    for (int y = -REACH; y <= REACH; y++)
        for (int x = -REACH; x <= REACH; x++) {
            ivec2 p = at + ivec2(x, y);
            if (p.x < 0 || p.y < 0 || p.x >= size.x || p.y >= size.y) continue;
            around += share_with_bounce(p) / pow(float(x * x + y * y), 1.5);
        }
    arriving = around.w > 0.0 ? around / around.w : vec4(1);
}
