// SPDX-License-Identifier: MIT
// src/optics/brdf.h and light.h: the microfacet BRDF of Karis 2013, and a lamp's light on a point of the surface.
const float PI = 3.14159265358979, F0 = 0.05;

float brdf_alpha2(float roughness) {
    float r = clamp(roughness, 0.03, 1.0);
    return r * r * r * r;
}

float brdf_k(float roughness) {
    float r = clamp(roughness, 0.03, 1.0);
    return (r + 1.0) * (r + 1.0) / 8.0;
}

// (n·h)²(α² − 1) + 1 of the angle's cosine and sine², which keeps its digits where float's n·h is 1.
float brdf_distribution(float alpha2, float n_h, float sine2) {
    float base = sine2 + n_h * n_h * alpha2;
    return alpha2 / (PI * base * base);
}

float brdf_fresnel(float v_h) {
    return F0 + (1.0 - F0) * exp2((-5.55473 * v_h - 6.98316) * v_h);
}

float brdf_visibility(float k, float n_l, float n_v) {
    return 1.0 / (4.0 * (n_l * (1.0 - k) + k) * (n_v * (1.0 - k) + k));
}

float brdf_specular(float roughness, vec3 n, vec3 l, vec3 v) {
    vec3 h = normalize(l + v + vec3(0, 0, 1e-9));
    float n_l = clamp(dot(n, l), 0.0, 1.0), n_v = clamp(dot(n, v), 0.0, 1.0);
    float n_h = clamp(dot(n, h), 0.0, 1.0), v_h = clamp(dot(v, h), 0.0, 1.0);
    float sine2 = (1.0 - n_h) * (1.0 + n_h);
    return brdf_distribution(brdf_alpha2(roughness), n_h, sine2) * brdf_fresnel(v_h) *
           brdf_visibility(brdf_k(roughness), n_l, n_v);
}

const int MOST_LAMPS = 4;
uniform int lamp_count;
uniform vec3 lamp_at[MOST_LAMPS];    // place; of a distant lamp the unit direction toward it
uniform bool lamp_far[MOST_LAMPS];
uniform vec3 lamp_light[MOST_LAMPS]; // Φ by channel
uniform bool matte;

// Radiance toward the unit v.
vec3 lamp_radiance(int i, surface s, vec3 point, vec3 v) {
    vec3 way = lamp_far[i] ? lamp_at[i] : lamp_at[i] - point;
    float distance2 = max(dot(way, way), 1e-6);
    vec3 l = way * inversesqrt(distance2);
    float n_l = clamp(dot(s.normal, l), 0.0, 1.0);
    vec3 f = s.albedo / PI;
    if (!matte && n_l > 0.0) f += brdf_specular(s.roughness, s.normal, l, v);
    return min(lamp_light[i] * f * (n_l / distance2), 6e4);
}
