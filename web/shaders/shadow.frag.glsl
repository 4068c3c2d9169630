// SPDX-License-Identifier: MIT
// How much of a lamp each point of the surface sees, as src/estimate/shadow.c has it: its ray is followed through the
// caster's depth, a pixel a step.
uniform sampler2D caster; // depth, continued off the surface, and 1 on it
uniform vec2 caster_span; // its nearest and farthest depth
uniform vec3 light_at;
uniform bool light_far;
in vec2 place;
out float seen;

const float THICKNESS = 0.15, THICKNESS_BORDER = 0.04, MARGIN = 1.0, BORDER = 1.0, BORDER_BY_WAY = 0.03, STEEPEST = 16.0;
const float NEVER = 1e30;

// Four texels around a place, whose centres are at whole numbers.
struct corners {
    ivec2 first, last;
    vec4 weight; // of upper left, upper right, lower left, lower right
};

corners corners_of(vec2 at) {
    ivec2 size = textureSize(caster, 0);
    vec2 inside = clamp(at, vec2(0), vec2(size - 1));
    ivec2 first = ivec2(inside), last = min(first + 1, size - 1);
    vec2 f = inside - vec2(first);
    return corners(first, last, vec4((1.0 - f.x) * (1.0 - f.y), f.x * (1.0 - f.y), (1.0 - f.x) * f.y, f.x * f.y));
}

vec4 depths_at(corners c) {
    return vec4(texelFetch(caster, c.first, 0).r, texelFetch(caster, ivec2(c.last.x, c.first.y), 0).r,
                texelFetch(caster, ivec2(c.first.x, c.last.y), 0).r, texelFetch(caster, c.last, 0).r);
}

bool near_surface(vec2 at) {
    ivec2 size = textureSize(caster, 0), corner = ivec2(floor(at)) - 1;
    for (int i = 0; i < 16; i++) {
        ivec2 p = corner + ivec2(i & 3, i >> 2);
        if (p.x < 0 || p.y < 0 || p.x >= size.x || p.y >= size.y) continue;
        if (texelFetch(caster, p, 0).g >= 0.5) return true;
    }
    return false;
}

// The share of the way over which there is anything to meet.
float part_with_occluders(vec3 p, vec3 way) {
    float behind = caster_span.y + THICKNESS + THICKNESS_BORDER, part = 1.0;
    if (p.z + way.z > -caster_span.x) part = (-caster_span.x - p.z) / way.z;
    if (p.z + way.z < -behind) part = (-behind - p.z) / way.z;
    return min(part, 1.0);
}

float steps_inside(float from, float along, int size) {
    if (along == 0.0) return NEVER;
    return ((along > 0.0 ? float(size) - 0.5 : -0.5) - from) / along;
}

// What a surface's depth grows by a pixel along one axis; more is a jump from part to part.
float slope_of(vec4 d, vec4 w, bool down, float pixel) {
    float change = down ? (w.x + w.z) * (d.z - d.x) + (w.y + w.w) * (d.w - d.y)
                        : (w.x + w.y) * (d.y - d.x) + (w.z + w.w) * (d.w - d.z);
    return abs(change) < STEEPEST * pixel ? change : 0.0;
}

float stops(ivec2 at, float depth, float margin, float border) {
    vec2 c = texelFetch(caster, at, 0).rg;
    float behind = depth - c.r, back = (THICKNESS - behind) / THICKNESS_BORDER + 1.0;
    float surely = clamp((behind - margin) / border, 0.0, 1.0) * clamp(back, 0.0, 1.0);
    return c.g >= 0.5 ? surely : 0.0;
}

void main() {
    ivec2 size = textureSize(caster, 0);
    vec2 at = place * vec2(size) - 0.5;
    seen = 1.0;
    if (!near_surface(at)) return;
    corners around = corners_of(at);
    vec4 depths = depths_at(around);
    float depth = dot(depths, around.weight);
    vec3 p = camera_ray(place) * depth, way = light_far ? light_at * (4.0 * caster_span.y) : light_at - p;
    float part = part_with_occluders(p, way);
    if (!(part > 0.0)) return;
    vec3 end = p + part * way;
    vec2 toward = camera_place(end) * vec2(size) - 0.5 - at;
    bool across = abs(toward.x) >= abs(toward.y);
    float count = max(abs(toward.x), abs(toward.y));
    if (!(count >= 1.0)) return;
    vec2 along = toward / count;
    float inverse = 1.0 / depth, inverse_along = (-1.0 / end.z - inverse) / count;
    float start = across ? at.x : at.y, forward = across ? toward.x : toward.y;
    float first = forward > 0.0 ? floor(start) + 1.0 - start : start - ceil(start) + 1.0;
    if (first < 0.5) first += 1.0; // that is the surface where it starts
    float way_by_step = part * length(way) * (-1.0 / end.z) / count;
    float pixel = 2.0 * tangent / float(size.x) * depth;
    float slope = slope_of(depths, around.weight, !across, pixel);
    count = min(count, min(steps_inside(at.x, along.x, size.x), steps_inside(at.y, along.y, size.y)));

    float hidden = 0.0, margin = MARGIN * pixel;
    ivec2 beside_step = across ? ivec2(0, 1) : ivec2(1, 0);
    for (float i = first; i < count && hidden < 1.0; i += 1.0) {
        vec2 q = clamp(at + i * along, vec2(0), vec2(size - 1));
        float ray = 1.0 / (inverse + i * inverse_along), border = BORDER * pixel + BORDER_BY_WAY * i * way_by_step * ray;
        ivec2 cell = across ? ivec2(int(q.x + 0.5), int(q.y)) : ivec2(int(q.x), int(q.y + 0.5));
        float beside = across ? q.y - float(cell.y) : q.x - float(cell.x);
        // the map's pixels lie beside the ray, where the surface that it starts from has another depth, too
        float a = stops(cell, ray - beside * slope, margin, border);
        float b = stops(min(cell + beside_step, size - 1), ray + (1.0 - beside) * slope, margin, border);
        hidden = max(hidden, mix(a, b, beside));
    }
    seen = 1.0 - hidden;
}
