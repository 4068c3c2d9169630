// SPDX-License-Identifier: MIT
// A map as a picture, as the PNG files beside maps.exr have it.
uniform int which; // 0 albedo, 1 normal, 2 roughness, 3 depth
uniform vec2 depth_span;
in vec2 place;
out vec4 color;

void main() {
    surface s = surface_at(ivec2(gl_FragCoord.xy));
    color = vec4(0);
    if (s.coverage == 0.0) return;
    vec3 code = vec3(s.roughness);
    if (which == 0) code = srgb_encode(s.albedo);
    if (which == 1) code = 0.5 * s.normal + 0.5;
    if (which == 3) code = vec3(1.0 - 0.95 * (s.depth - depth_span.x) / (depth_span.y - depth_span.x + 1e-6));
    // the target encodes; at the outline a map is whole, and covers what it covers
    color = vec4(srgb_decode(clamp(code, 0.0, 1.0)) * s.coverage, s.coverage);
}
