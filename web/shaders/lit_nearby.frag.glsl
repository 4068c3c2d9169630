// SPDX-License-Identifier: MIT
// Sums along one axis of what surfaces send and of how many there are: first of products, then of sums.
uniform sampler2D share, low_albedo, low_normal, sums;
uniform bool first;
uniform int radius;
out vec4 sum;

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy), size = textureSize(low_albedo, 0);
    ivec2 along = first ? ivec2(1, 0) : ivec2(0, 1);
    sum = vec4(0);
    for (int i = -radius; i <= radius; i++) {
        ivec2 p = at + i * along;
        if (p.x < 0 || p.y < 0 || p.x >= size.x || p.y >= size.y) continue;
        if (!first) {
            sum += texelFetch(sums, p, 0);
            continue;
        }
        vec4 a = texelFetch(low_albedo, p, 0);
        if (a.w == 0.0) continue;
        vec3 lit = a.rgb / 3.14159265358979 * sh_irradiance(texelFetch(low_normal, p, 0).xyz);
        sum += vec4(lit * texelFetch(share, p, 0).rgb, 1.0);
    }
}
