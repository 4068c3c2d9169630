// SPDX-License-Identifier: MIT
// Radiance of a room's light on every pixel: diffuse by nine spherical harmonics and the share of them that arrives,
// reflections by 64 places on the specular lobe over the panorama (src/estimate/lobe.c).
uniform sampler2D arriving, sky; // sky: an octahedron and its halvings (web/sky.js)
uniform vec2 turn;
uniform bool matte;
uniform int stride; // of how many pixels a side one is drawn
uniform vec3 places[64]; // on the lobe: u, and the cosine and sine of the angle about it
out vec4 color;

const float PI = 3.14159265358979, F0 = 0.05, OVERLAP = 2.0;

// Beyond an edge of the square the octahedron goes on at the same edge, mirrored.
vec3 sky_texel(ivec2 p, int level, int n) {
    if (p.x < 0 || p.x >= n) p = ivec2(p.x < 0 ? -1 - p.x : 2 * n - 1 - p.x, n - 1 - p.y);
    if (p.y < 0 || p.y >= n) p = ivec2(n - 1 - p.x, p.y < 0 ? -1 - p.y : 2 * n - 1 - p.y);
    return texelFetch(sky, p, level).rgb;
}

vec3 sky_level(vec2 at, int level) {
    int n = textureSize(sky, level).x;
    vec2 p = at * float(n) - 0.5;
    ivec2 first = ivec2(floor(p));
    vec2 f = p - vec2(first);
    return mix(mix(sky_texel(first, level, n), sky_texel(first + ivec2(1, 0), level, n), f.x),
               mix(sky_texel(first + ivec2(0, 1), level, n), sky_texel(first + 1, level, n), f.x), f.y);
}

vec2 octahedron_place(vec3 d) {
    float r = sqrt(max(0.0, 1.0 - abs(d.z)));
    float v = r * atan(abs(d.y), abs(d.x)) * (2.0 / PI), u = r - v;
    if (d.z < 0.0) {
        float t = u;
        u = 1.0 - v;
        v = 1.0 - t;
    }
    return 0.5 + 0.5 * vec2(d.x < 0.0 ? -u : u, d.y < 0.0 ? -v : v);
}

vec3 sky_about(vec3 d, float solid_angle) {
    float n = float(textureSize(sky, 0).x), finest = 4.0 * PI / (n * n), last = log2(n) - 1.0;
    vec3 unturned = vec3(turn.x * d.x + turn.y * d.z, d.y, turn.x * d.z - turn.y * d.x);
    float level = min(0.5 * log2(max(solid_angle, finest) / finest), last);
    int fine = int(level), coarse = min(fine + 1, int(last));
    vec2 at = octahedron_place(unturned);
    return mix(sky_level(at, fine), sky_level(at, coarse), level - float(fine));
}

// local (z along n) to the space of n (Duff et al. 2017).
vec3 to_world(vec3 local, vec3 n) {
    float s = n.z < 0.0 ? -1.0 : 1.0, a = -1.0 / (s + n.z), b = n.x * n.y * a;
    return local.x * vec3(1.0 + s * n.x * n.x * a, s * b, -s * n.x) + local.y * vec3(b, s + n.y * n.y * a, -n.y) +
           local.z * n;
}

vec3 reflection(surface s, vec3 v, sky_view edge) {
    float r = clamp(s.roughness, 0.03, 1.0), alpha2 = r * r * r * r, k = (r + 1.0) * (r + 1.0) / 8.0;
    float n_v = clamp(dot(s.normal, v), 0.0, 1.0);
    vec3 sum = vec3(0);
    for (int i = 0; i < 64; i++) {
        float cosine2 = (1.0 - places[i].x) / (1.0 + (alpha2 - 1.0) * places[i].x);
        float sine = sqrt(max(0.0, 1.0 - cosine2)), n_h = sqrt(cosine2);
        vec3 h = to_world(vec3(sine * places[i].yz, n_h), s.normal);
        float v_h = dot(v, h);
        vec3 l = 2.0 * v_h * h - v;
        float n_l = dot(s.normal, l);
        if (v_h <= 0.0 || n_l <= 0.0) continue;
        float base = (1.0 - n_h) * (1.0 + n_h) + n_h * n_h * alpha2;
        float angle = 4.0 * v_h * PI * base * base / (alpha2 * n_h * 64.0); // that the place stands for
        float fresnel = F0 + (1.0 - F0) * exp2((-5.55473 * v_h - 6.98316) * v_h);
        float visible = 1.0 / (4.0 * (min(n_l, 1.0) * (1.0 - k) + k) * (n_v * (1.0 - k) + k));
        float weight = fresnel * visible * 4.0 * n_l * v_h / n_h * sky_seen(edge, l, angle);
        sum += sky_about(l, OVERLAP * angle) * (weight / 64.0);
    }
    return sum;
}

void main() {
    ivec2 size = textureSize(shape, 0), pixel = min(ivec2(gl_FragCoord.xy) * stride + stride / 2, size - 1);
    vec2 at = (vec2(pixel) + 0.5) / vec2(size);
    surface s = surface_at(pixel);
    color = vec4(0);
    if (s.coverage == 0.0) return;
    vec3 v = -normalize(camera_ray(at));
    vec3 sum = s.albedo / PI * sh_irradiance(s.normal) * texture(arriving, at).rgb;
    if (!matte) sum += reflection(s, v, sky_at(at));
    color = vec4(min(s.coverage * sum, 6e4), 1.0);
}
