// SPDX-License-Identifier: MIT
// The picture on the screen, enlarged and moved; left of the divider another one.
uniform sampler2D picture, other;
uniform vec2 view_size;   // of the screen's part, in its pixels
uniform vec2 origin;      // the picture's upper left corner there
uniform float scale;      // screen pixels a pixel
uniform float divider;    // in screen pixels; below 0: none
uniform bool sharp;       // pixels are squares
uniform vec3 backdrop;    // linear
in vec2 place;
out vec4 color;

vec4 look(sampler2D from, vec2 at, vec2 size) {
    if (sharp) return texelFetch(from, ivec2(at), 0);
    return texture(from, at / size);
}

void main() {
    vec2 screen = vec2(gl_FragCoord.x, view_size.y - gl_FragCoord.y), size = vec2(textureSize(picture, 0));
    vec2 at = (screen - origin) / scale;
    bool first = screen.x < divider;
    // taken before it is known whether they are wanted: the derivatives that choose a mipmap want it so
    vec4 a = look(picture, clamp(at, vec2(0), size - 0.001), size), b = look(other, clamp(at, vec2(0), size - 0.001), size);
    vec4 c = first ? b : a;
    if (at.x < 0.0 || at.y < 0.0 || at.x >= size.x || at.y >= size.y) c = vec4(0);
    color = vec4(srgb_encode(c.rgb + (1.0 - c.a) * backdrop), 1.0);
}
