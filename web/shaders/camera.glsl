// SPDX-License-Identifier: MIT
// The camera of src/optics/camera.h for a square picture; places are shares of it, from its upper left corner.
uniform vec3 plane_right, plane_up;
uniform vec2 slant;
uniform float tangent; // of half the field of view

// The point of depth 1 seen at a place: (X, Y, -1).
vec3 camera_ray(vec2 place) {
    float u = (place.x - 0.5) * 2.0 * tangent, v = (0.5 - place.y) * 2.0 * tangent;
    float z = 1.0 - u * plane_right.z - v * plane_up.z;
    return vec3((u * plane_right.xy + v * plane_up.xy) / z, -1.0);
}

// Where a point before the camera is seen.
vec2 camera_place(vec3 p) {
    float scale = -sqrt(1.0 - dot(slant, slant)) / dot(p, cross(plane_right, plane_up));
    vec2 plane = vec2(scale * dot(p, plane_right), scale * dot(p, plane_up)) - slant;
    return vec2(0.5 + plane.x / (2.0 * tangent), 0.5 - plane.y / (2.0 * tangent));
}
