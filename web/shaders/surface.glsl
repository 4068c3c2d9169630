// SPDX-License-Identifier: MIT
// The maps of the picture, one texel a pixel, as whole numbers (src/view/view_planes.c writes them):
// material = red, green, blue, roughness; shape = normal x, normal y, depth, coverage.
uniform usampler2D material, shape;
uniform vec2 depth_range; // nearest and farthest

struct surface {
    vec3 albedo;
    float roughness;
    vec3 normal;
    float depth, coverage;
};

const float LEAST_ROUGHNESS = 0.03;

surface surface_at(ivec2 pixel) {
    vec4 m = vec4(texelFetch(material, pixel, 0)), s = vec4(texelFetch(shape, pixel, 0));
    vec3 root = m.rgb / 4095.0;
    vec2 across = (s.xy - 4096.0) / 4096.0;
    float up = sqrt(max(1.0 - dot(across, across), 0.0));
    float depth = mix(depth_range.x, depth_range.y, s.z / 65535.0);
    float roughness = LEAST_ROUGHNESS * pow(1.0 / LEAST_ROUGHNESS, m.a / 4095.0);
    return surface(root * root, roughness, normalize(vec3(across, up) + vec3(0, 0, 1e-6)), depth, s.w / 255.0);
}

// Between the pixels, where the surface is turned about; place in shares of the picture. Those off the object, which
// hold nothing, do not count.
surface surface_between(vec2 place) {
    ivec2 size = textureSize(shape, 0);
    vec2 at = place * vec2(size) - 0.5;
    ivec2 corner = ivec2(floor(at));
    vec2 f = at - vec2(corner);
    surface sum = surface(vec3(0), 0.0, vec3(0), 0.0, 0.0);
    float all = 0.0;
    for (int i = 0; i < 4; i++) {
        ivec2 side = ivec2(i & 1, i >> 1);
        surface s = surface_at(clamp(corner + side, ivec2(0), size - 1));
        float w = (side.x == 1 ? f.x : 1.0 - f.x) * (side.y == 1 ? f.y : 1.0 - f.y);
        sum.coverage += w * s.coverage;
        if (s.coverage == 0.0) continue;
        sum.albedo += w * s.albedo;
        sum.roughness += w * s.roughness;
        sum.normal += w * s.normal;
        sum.depth += w * s.depth;
        all += w;
    }
    float scale = 1.0 / max(all, 1e-6);
    return surface(sum.albedo * scale, sum.roughness * scale, normalize(sum.normal + vec3(0, 0, 1e-6)),
                   sum.depth * scale, sum.coverage);
}
