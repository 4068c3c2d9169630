// SPDX-License-Identifier: MIT
// What the surface hides of its surroundings, as src/estimate/horizon.c has it: for one half plane through each point's
// line of sight, the cosine of the horizon's angle (as bits) and which parts beyond it are closed.
uniform sampler2D caster;
uniform int azimuth;
uniform float step_size; // the caster's pixels from point to point
in vec2 place;
out uvec2 kept;

const float MARGIN = 1.0, STRIDE = 0.06, THICKNESS = 0.15;

// The bits whose middles are between two cosines; shifts by 32 are two.
uint bits_between(float low, float high) {
    int first = int(16.0 * (low + 1.0) + 0.5), end = int(16.0 * (high + 1.0) + 0.5);
    uint all = 0xffffffffu, from = all << (first >> 1) << (first - (first >> 1));
    uint to = all << (end >> 1) << (end - (end >> 1));
    return from & ~to;
}

float cosine_to(vec3 to, vec3 view) {
    return clamp(dot(to, view) / sqrt(dot(to, to) + 1e-20), -1.0, 1.0);
}

// A point next to the surface counts, too: finer pictures interpolate between it and the next.
bool near_surface(vec2 at, ivec2 size) {
    for (int k = 0; k < 9; k++) {
        ivec2 p = ivec2(floor(at + step_size * vec2(k % 3 - 1, k / 3 - 1) + 0.5));
        if (p.x < 0 || p.y < 0 || p.x >= size.x || p.y >= size.y) continue;
        if (texelFetch(caster, p, 0).g >= 0.5) return true;
    }
    return false;
}

float depth_at(vec2 at, ivec2 size) {
    ivec2 first = ivec2(at), last = min(first + 1, size - 1);
    vec2 f = at - vec2(first);
    float above = mix(texelFetch(caster, first, 0).r, texelFetch(caster, ivec2(last.x, first.y), 0).r, f.x);
    float below = mix(texelFetch(caster, ivec2(first.x, last.y), 0).r, texelFetch(caster, last, 0).r, f.x);
    return mix(above, below, f.y);
}

void main() {
    ivec2 size = textureSize(caster, 0);
    vec2 at = place * vec2(size) - 0.5;
    kept = uvec2(floatBitsToUint(-1.0), 0u);
    if (!near_surface(at, size)) return;
    vec3 ray = camera_ray(place), p = ray * depth_at(max(at, vec2(0)), size), view = -normalize(ray);
    sight_frame f = frame_of(view);
    vec3 across = across_of(f, azimuth);
    // a straight line in space along "across" is one in the picture
    vec2 along = vec2(across.z * p.x - across.x * p.z, across.y * p.z - across.z * p.y);
    along *= inversesqrt(dot(along, along) + 1e-30);
    float pixel = 2.0 * tangent / float(size.x), most = -1.0, farthest = float(size.x + size.y);
    uint closed = 0u;
    for (float way = 1.0; way < farthest; way += max(1.0, STRIDE * way)) {
        vec2 q = roundEven(at + way * along);
        if (q.x < 0.0 || q.y < 0.0 || q.x >= float(size.x) || q.y >= float(size.y)) break;
        vec2 c = texelFetch(caster, ivec2(q), 0).rg;
        if (c.g < 0.5) continue;
        float front = c.r * (1.0 + MARGIN * pixel), back = front + THICKNESS;
        vec3 there = vec3((q.x - 0.5 * float(size.x - 1)) * pixel, (0.5 * float(size.y - 1) - q.y) * pixel, -1.0);
        float high = cosine_to(there * front - p, view), low = cosine_to(there * back - p, view);
        most = max(most, high);
        closed |= bits_between(min(low, high), high);
    }
    kept = uvec2(floatBitsToUint(most), closed | bits_between(most, 1.0));
}
