// SPDX-License-Identifier: MIT
// Three numbers, and the camera of src/optics/camera.h.
export const add = (a, b) => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
export const scaled = (a, s) => [a[0] * s, a[1] * s, a[2] * s];
export const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
export const normalized = (a) => scaled(a, 1 / (Math.hypot(...a) || 1));
export const clamp = (x, low, high) => Math.min(Math.max(x, low), high);

export class Camera {
    constructor(tangent, [right, up]) {
        const forward = Math.sqrt(1 - right * right - up * up), share = 1 / (1 + forward);
        this.tangent = tangent;
        this.slant = [right, up];
        this.forward = forward;
        this.right = [1 - right * right * share, -right * up * share, -right];
        this.up = [-right * up * share, 1 - up * up * share, -up];
        this.behind = cross(this.right, this.up);
    }

    // The point of depth 1 at a place, and the place of a point: shares of the picture from its upper left corner.
    ray([x, y]) {
        const u = (x - 0.5) * 2 * this.tangent, v = (0.5 - y) * 2 * this.tangent, z = 1 - u * this.right[2] - v * this.up[2];
        return [(u * this.right[0] + v * this.up[0]) / z, (u * this.right[1] + v * this.up[1]) / z, -1];
    }

    place(p) {
        const scale = -this.forward / dot(p, this.behind);
        return [0.5 + (scale * dot(p, this.right) - this.slant[0]) / (2 * this.tangent),
            0.5 - (scale * dot(p, this.up) - this.slant[1]) / (2 * this.tangent)];
    }

    // What the shaders of camera.glsl are told.
    uniforms() {
        return { plane_right: this.right, plane_up: this.up, slant: this.slant, tangent: this.tangent };
    }

    // From the camera's space to the picture's square, which is (-1, -1) to (1, 1), by columns.
    matrix(near, far) {
        const w = scaled(this.behind, -1 / this.forward), rows = [];
        rows[0] = scaled(add(this.right, scaled(w, -this.slant[0])), 1 / this.tangent);
        rows[1] = scaled(add(this.up, scaled(w, -this.slant[1])), 1 / this.tangent);
        rows[2] = scaled(w, (far + near) / (far - near));
        rows[3] = w;
        const shift = [0, 0, (-2 * far * near) / (far - near), 0], out = new Float32Array(16);
        for (let r = 0; r < 4; r++) {
            for (let c = 0; c < 3; c++) out[4 * c + r] = rows[r][c];
            out[12 + r] = shift[r];
        }
        return out;
    }
}

// The product of two matrices of four columns.
export function product(a, b) {
    const out = new Float32Array(16);
    for (let c = 0; c < 4; c++)
        for (let r = 0; r < 4; r++)
            for (let k = 0; k < 4; k++) out[4 * c + r] += a[4 * k + r] * b[4 * c + k];
    return out;
}
