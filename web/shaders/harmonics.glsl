// SPDX-License-Identifier: MIT
// Nine spherical harmonics of radiance (src/optics/sh.h), each with what the clamped cosine keeps of its band.
uniform vec3 sh[9];

vec3 sh_irradiance(vec3 d) {
    vec3 e = sh[0] * 0.28209479 + sh[1] * (0.48860251 * d.y) + sh[2] * (0.48860251 * d.z) + sh[3] * (0.48860251 * d.x);
    e += sh[4] * (1.09254843 * d.x * d.y) + sh[5] * (1.09254843 * d.y * d.z);
    e += sh[6] * (0.31539157 * (3.0 * d.z * d.z - 1.0)) + sh[7] * (1.09254843 * d.x * d.z);
    e += sh[8] * (0.54627422 * (d.x * d.x - d.y * d.y));
    return max(e, 0.0);
}
