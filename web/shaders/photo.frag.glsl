// SPDX-License-Identifier: MIT
// The photograph, with the object's coverage: its pixels are times that already.
uniform sampler2D photo;
in vec2 place;
out vec4 color;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    color = vec4(srgb_decode(texelFetch(photo, pixel, 0).rgb), surface_at(pixel).coverage);
}
