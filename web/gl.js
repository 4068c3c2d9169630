// SPDX-License-Identifier: MIT
// WebGL2 with few words: programs whose uniforms are set by name, textures, and targets to draw into.
import { shaders } from "./shaders.js";

// Everything is drawn from chunks of web/shaders, the last of which has main().
const HEAD = `#version 300 es
precision highp float;
precision highp int;
precision highp sampler2D;
precision highp usampler2D;
precision highp usampler2DArray;
`;

export class Broken extends Error {}

export function startGl(canvas) {
    const gl = canvas.getContext("webgl2", { antialias: true, alpha: false, depth: true, powerPreference: "high-performance" });
    if (!gl) throw new Broken("This browser shows no WebGL2: the picture cannot be lit here.");
    if (!gl.getExtension("EXT_color_buffer_float") && !gl.getExtension("EXT_color_buffer_half_float"))
        throw new Broken("This graphics driver draws no floating-point pictures: the picture cannot be lit here.");
    gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
    gl.pixelStorei(gl.UNPACK_COLORSPACE_CONVERSION_WEBGL, gl.NONE);
    gl.pixelStorei(gl.UNPACK_PREMULTIPLY_ALPHA_WEBGL, false);
    return gl;
}

function compile(gl, kind, names) {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, HEAD + names.map((name) => shaders[name]).join("\n"));
    gl.compileShader(shader);
    return shader;
}

// The rest of a uniform's setter's name, by its type.
function setterOf(gl, type) {
    const names = {
        [gl.FLOAT]: "1f", [gl.FLOAT_VEC2]: "2f", [gl.FLOAT_VEC3]: "3f", [gl.FLOAT_VEC4]: "4f", [gl.INT]: "1i", [gl.BOOL]: "1i",
        [gl.FLOAT_MAT4]: "Matrix4f",
    };
    return names[type] || "sampler";
}

// program.set({name: value}); textures are given as textures, arrays as flat lists of numbers.
export class Program {
    constructor(gl, vertex, fragment) {
        this.gl = gl;
        this.name = fragment[fragment.length - 1];
        this.handle = gl.createProgram();
        this.parts = [compile(gl, gl.VERTEX_SHADER, vertex), compile(gl, gl.FRAGMENT_SHADER, fragment)];
        for (const part of this.parts) gl.attachShader(this.handle, part);
        gl.linkProgram(this.handle);
    }

    // Asks for errors when the program is first wanted: all have been given to the driver by then.
    finish() {
        const gl = this.gl;
        if (!gl.getProgramParameter(this.handle, gl.LINK_STATUS) && !gl.isContextLost()) {
            const why = this.parts.map((part) => gl.getShaderInfoLog(part)).join("") || gl.getProgramInfoLog(this.handle);
            throw new Broken(`The graphics driver refuses ${this.name}: ${why}`);
        }
        this.uniforms = new Map();
        let unit = 0;
        for (let i = 0; i < gl.getProgramParameter(this.handle, gl.ACTIVE_UNIFORMS); i++) {
            const info = gl.getActiveUniform(this.handle, i), name = info.name.replace("[0]", "");
            const setter = setterOf(gl, info.type), place = gl.getUniformLocation(this.handle, info.name);
            this.uniforms.set(name, { setter, place, unit: setter === "sampler" ? unit++ : -1 });
        }
    }

    set(values) {
        const gl = this.gl;
        if (!this.uniforms) this.finish();
        gl.useProgram(this.handle);
        for (const [name, value] of Object.entries(values)) {
            const u = this.uniforms.get(name);
            if (!u) continue;
            if (u.setter === "sampler") {
                gl.activeTexture(gl.TEXTURE0 + u.unit);
                gl.bindTexture(value.kind, value.handle);
                gl.uniform1i(u.place, u.unit);
            } else if (u.setter === "Matrix4f") {
                gl.uniformMatrix4fv(u.place, false, value);
            } else {
                gl[`uniform${u.setter}v`](u.place, Array.isArray(value) || ArrayBuffer.isView(value) ? value : [Number(value)]);
            }
        }
        return this;
    }
}

// How a texture's values are stored: what it is called inside, and how it is filled.
function formatOf(gl, name) {
    const formats = {
        rgba16ui: [gl.RGBA16UI, gl.RGBA_INTEGER, gl.UNSIGNED_SHORT],
        rg32ui: [gl.RG32UI, gl.RG_INTEGER, gl.UNSIGNED_INT],
        rg32f: [gl.RG32F, gl.RG, gl.FLOAT],
        rgba32f: [gl.RGBA32F, gl.RGBA, gl.FLOAT],
        rgba16f: [gl.RGBA16F, gl.RGBA, gl.HALF_FLOAT],
        r16f: [gl.R16F, gl.RED, gl.HALF_FLOAT],
        rgba8: [gl.RGBA8, gl.RGBA, gl.UNSIGNED_BYTE],
        srgb8: [gl.SRGB8_ALPHA8, gl.RGBA, gl.UNSIGNED_BYTE],
    };
    return formats[name];
}

// width × height; data: an array of numbers, a picture or nothing. Nothing else is filtered than what asks for it.
export function makeTexture(gl, format, width, height, { data = null, smooth = false, levels = 1, layers = 0 } = {}) {
    const [inside, outside, type] = formatOf(gl, format), kind = layers ? gl.TEXTURE_2D_ARRAY : gl.TEXTURE_2D;
    const texture = { kind, handle: gl.createTexture(), width, height, levels };
    gl.activeTexture(gl.TEXTURE0);
    gl.bindTexture(kind, texture.handle);
    if (layers) gl.texStorage3D(kind, levels, inside, width, height, layers);
    else gl.texStorage2D(kind, levels, inside, width, height);
    if (data && (ArrayBuffer.isView(data))) gl.texSubImage2D(kind, 0, 0, 0, width, height, outside, type, data);
    else if (data) gl.texSubImage2D(kind, 0, 0, 0, outside, type, data);
    const far = levels > 1 && smooth ? gl.LINEAR_MIPMAP_LINEAR : levels > 1 ? gl.NEAREST_MIPMAP_NEAREST : smooth ? gl.LINEAR : gl.NEAREST;
    gl.texParameteri(kind, gl.TEXTURE_MIN_FILTER, far);
    gl.texParameteri(kind, gl.TEXTURE_MAG_FILTER, smooth ? gl.LINEAR : gl.NEAREST);
    gl.texParameteri(kind, gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE);
    gl.texParameteri(kind, gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE);
    return texture;
}

export function fillLevel(gl, texture, format, level, data) {
    const [, outside, type] = formatOf(gl, format);
    gl.activeTexture(gl.TEXTURE0);
    gl.bindTexture(texture.kind, texture.handle);
    gl.texSubImage2D(texture.kind, level, 0, 0, texture.width >> level, texture.height >> level, outside, type, data);
}

// A framebuffer for one or more textures of one size; layer: of the first, which has several.
export function makeTarget(gl, textures, layer = -1) {
    const target = { handle: gl.createFramebuffer(), textures, width: textures[0].width, height: textures[0].height };
    gl.bindFramebuffer(gl.FRAMEBUFFER, target.handle);
    textures.forEach((texture, i) => {
        if (layer >= 0) gl.framebufferTextureLayer(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0 + i, texture.handle, 0, layer);
        else gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0 + i, texture.kind, texture.handle, 0);
    });
    gl.drawBuffers(textures.map((_, i) => gl.COLOR_ATTACHMENT0 + i));
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    return target;
}

export function levelsOf(side) {
    return Math.floor(Math.log2(side)) + 1;
}

// Fills a target, or rows of it, by a program of whole.vert.glsl.
export function fill(gl, target, program, values, rows = null) {
    program.set(values);
    gl.bindFramebuffer(gl.FRAMEBUFFER, target ? target.handle : null);
    if (target) gl.viewport(0, 0, target.width, target.height);
    gl.disable(gl.DEPTH_TEST);
    gl.disable(gl.CULL_FACE);
    if (rows) {
        gl.enable(gl.SCISSOR_TEST);
        gl.scissor(0, rows[0], target.width, rows[1] - rows[0]);
    }
    gl.drawArrays(gl.TRIANGLES, 0, 3);
    if (rows) gl.disable(gl.SCISSOR_TEST);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
}
