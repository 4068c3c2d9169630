// SPDX-License-Identifier: MIT
// The use of the horizon: which share of a patch of sky a point of the surface sees, 0 to 1.
uniform highp usampler2DArray horizon;

const float BITS = 32.0, EDGE = 0.06;

struct sky_view {
    sight_frame f;
    ivec2 at[4];
    vec4 weight;
};

sky_view sky_at(vec2 place) {
    ivec2 size = textureSize(horizon, 0).xy;
    vec2 at = clamp(place * vec2(size) - 0.5, vec2(0), vec2(size - 1));
    ivec2 first = ivec2(at), last = min(first + 1, size - 1);
    vec2 f = at - vec2(first);
    sky_view v;
    v.f = frame_of(-normalize(camera_ray(place)));
    v.at[0] = first;
    v.at[1] = ivec2(last.x, first.y);
    v.at[2] = ivec2(first.x, last.y);
    v.at[3] = last;
    v.weight = vec4((1.0 - f.x) * (1.0 - f.y), f.x * (1.0 - f.y), (1.0 - f.x) * f.y, f.x * f.y);
    return v;
}

// The horizon's cosine, and how open it is beyond it, in one half plane.
vec2 edge_and_open(sky_view v, int azimuth, float cosine) {
    float at = clamp(0.5 * BITS * (cosine + 1.0) - 0.5, 0.0, BITS - 1.001);
    int bit = int(at);
    float between = at - float(bit);
    vec2 sum = vec2(0);
    for (int k = 0; k < 4; k++) {
        uvec2 h = texelFetch(horizon, ivec3(v.at[k], azimuth), 0).rg;
        uint open = ~h.g;
        float through = mix(float(open >> bit & 1u), float(open >> (bit + 1) & 1u), between);
        sum += v.weight[k] * vec2(uintBitsToFloat(h.r), through);
    }
    return sum;
}

float sky_seen(sky_view v, vec3 direction, float solid_angle) {
    float x = dot(direction, v.f.right), y = dot(direction, v.f.up), z = dot(direction, v.f.view);
    float azimuth = azimuth_of(x, y), between = azimuth - floor(azimuth);
    int below = int(azimuth) % AZIMUTHS, above = (below + 1) % AZIMUTHS;
    vec2 both = mix(edge_and_open(v, below, z), edge_and_open(v, above, z), between);
    // of cosines, that many are as wide as so many angles
    float width = sqrt((EDGE * EDGE + solid_angle) * (x * x + y * y)) + 1e-6;
    float seen = clamp((z - both.x) / width + 0.5, 0.0, 1.0);
    return seen + (1.0 - seen) * both.y;
}
