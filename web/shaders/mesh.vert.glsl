// SPDX-License-Identifier: MIT
// The caster's depth as a surface that is turned about: one vertex a pixel, numbered by rows.
uniform sampler2D caster;
uniform mat4 view; // from the camera's space to the screen
out vec2 place;
out vec3 point;

void main() {
    ivec2 size = textureSize(caster, 0);
    ivec2 pixel = ivec2(gl_VertexID % size.x, gl_VertexID / size.x);
    place = (vec2(pixel) + 0.5) / vec2(size);
    point = camera_ray(place) * texelFetch(caster, pixel, 0).r;
    gl_Position = view * vec4(point, 1.0);
}
