// SPDX-License-Identifier: MIT
// Directions about a line of sight, in half planes that are numbered around a square (src/estimate/horizon.c).
const int AZIMUTHS = 24, QUARTER = 6;

struct sight_frame {
    vec3 view, right, up;
};

sight_frame frame_of(vec3 view) {
    vec3 right = normalize(vec3(1, 0, 0) - view.x * view);
    return sight_frame(view, right, cross(view, right));
}

vec3 across_of(sight_frame f, int azimuth) {
    int quarter = azimuth / QUARTER;
    float t = float(azimuth % QUARTER) / float(QUARTER), x = quarter % 2 == 1 ? t : 1.0 - t;
    float sign_x = quarter == 0 || quarter == 3 ? 1.0 : -1.0, sign_y = quarter < 2 ? 1.0 : -1.0;
    return sign_x * x * f.right + sign_y * (1.0 - x) * f.up;
}

float azimuth_of(float x, float y) {
    float sum = abs(x) + abs(y), t = sum > 0.0 ? y / sum : 0.0;
    return (x < 0.0 ? 2.0 - t : t < 0.0 ? 4.0 + t : t) * float(QUARTER);
}
