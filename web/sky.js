// SPDX-License-Identifier: MIT
// A room's light made ready to be looked up: radiance on an octahedron unfolded into a square of equal areas, with its
// halvings (src/estimate/env_map.c); as nine spherical harmonics; and as a few distant lights (env_lights.c).
import { normalized } from "./vector.js";

export const SKY_LEVELS = 9, SKY_SIDE = 1 << SKY_LEVELS;
const WIDEST = 2 * SKY_SIDE;
const LIGHTS_LEVEL = 3, HALVINGS = 8, SPHERE = 4 * Math.PI;
const luminance = (r, g, b) => 0.2126 * r + 0.7152 * g + 0.0722 * b;

export function basis([x, y, z]) {
    return [0.28209479177387814, 0.4886025119029199 * y, 0.4886025119029199 * z, 0.4886025119029199 * x,
        1.0925484305920792 * x * y, 1.0925484305920792 * y * z, 0.31539156525252005 * (3 * z * z - 1),
        1.0925484305920792 * x * z, 0.5462742152960396 * (x * x - y * y)];
}

function octahedronDirection(x, y) {
    const u = Math.abs(2 * x - 1), v = Math.abs(2 * y - 1), height = 1 - (u + v), r = 1 - Math.abs(height);
    const around = r > 0 ? (Math.PI / 4) * ((v - u) / r + 1) : 0, across = r * Math.sqrt(2 - r * r);
    const signed = (a, s) => (s < 0 ? -a : a);
    return [signed(across * Math.cos(around), x - 0.5), signed(across * Math.sin(around), y - 0.5),
        signed(1 - r * r, height)];
}

// Both share this picture of latitude and longitude: {width, height, data: red, green, blue by rows from the top}.
function shrink(map) {
    let { width, height, data } = map;
    while (width > WIDEST && width % 2 === 0 && height % 2 === 0) {
        const w = width / 2, h = height / 2, out = new Float32Array(3 * w * h);
        for (let y = 0; y < h; y++)
            for (let x = 0; x < w; x++)
                for (let c = 0; c < 3; c++) {
                    const i = 3 * (2 * y * width + 2 * x) + c, j = i + 3 * width;
                    out[3 * (y * w + x) + c] = 0.25 * (data[i] + data[i + 3] + data[j] + data[j + 3]);
                }
        [width, height, data] = [w, h, out];
    }
    return { width, height, data };
}

// Every texel is cut into pieces no larger than a third of a cell, and each cell is the mean of what falls into it.
function toOctahedron(map) {
    const sum = new Float32Array(3 * SKY_SIDE * SKY_SIDE), angles = new Float32Array(SKY_SIDE * SKY_SIDE);
    const cell = Math.sqrt(SPHERE) / SKY_SIDE, { width, height, data } = map;
    const down = Math.ceil((3 * Math.PI) / (height * cell));
    for (let y = 0; y < height * down; y++) {
        const v = (y + 0.5) / (height * down), level = Math.cos(Math.PI * v), s = Math.sin(Math.PI * v);
        const across = width * Math.ceil((6 * Math.PI * s) / (width * cell));
        const angle = ((Math.cos((Math.PI * y) / (height * down)) - Math.cos((Math.PI * (y + 1)) / (height * down))) * 2 * Math.PI) / across;
        const row = 3 * width * Math.floor(y / down), pieces = across / width;
        for (let x = 0; x < across; x++) {
            const a = ((x + 0.5) / across - 0.5) * 2 * Math.PI, dx = s * Math.sin(a), dz = -s * Math.cos(a);
            const r = Math.sqrt(Math.max(0, 1 - Math.abs(dz)));
            let q = (r * Math.atan2(Math.abs(level), Math.abs(dx)) * 2) / Math.PI, p = r - q;
            if (dz < 0) [p, q] = [1 - q, 1 - p];
            const column = Math.min(Math.floor((0.5 + 0.5 * (dx < 0 ? -p : p)) * SKY_SIDE), SKY_SIDE - 1);
            const line = Math.min(Math.floor((0.5 + 0.5 * (level < 0 ? -q : q)) * SKY_SIDE), SKY_SIDE - 1);
            const to = line * SKY_SIDE + column, from = row + 3 * Math.floor(x / pieces);
            sum[3 * to] += data[from] * angle;
            sum[3 * to + 1] += data[from + 1] * angle;
            sum[3 * to + 2] += data[from + 2] * angle;
            angles[to] += angle;
        }
    }
    const out = new Float32Array(4 * SKY_SIDE * SKY_SIDE);
    for (let i = 0; i < SKY_SIDE * SKY_SIDE; i++)
        for (let c = 0; c < 3; c++) out[4 * i + c] = angles[i] > 0 ? sum[3 * i + c] / angles[i] : 0;
    return out;
}

function halvings(finest) {
    const levels = [finest];
    for (let i = 1; i < SKY_LEVELS; i++) {
        const from = levels[i - 1], side = SKY_SIDE >> i, out = new Float32Array(4 * side * side);
        for (let y = 0; y < side; y++)
            for (let x = 0; x < side; x++)
                for (let c = 0; c < 3; c++) {
                    const a = 4 * (4 * y * side + 2 * x) + c, b = a + 8 * side;
                    out[4 * (y * side + x) + c] = 0.25 * (from[a] + from[a + 4] + from[b] + from[b + 4]);
                }
        levels.push(out);
    }
    return levels;
}

function project(map) {
    const sh = Array.from({ length: 9 }, () => [0, 0, 0]), { width, height, data } = map;
    for (let y = 0; y < height; y++) {
        const angle = ((Math.cos((Math.PI * y) / height) - Math.cos((Math.PI * (y + 1)) / height)) * 2 * Math.PI) / width;
        const v = (Math.PI * (y + 0.5)) / height, s = Math.sin(v), up = Math.cos(v);
        for (let x = 0; x < width; x++) {
            const a = ((x + 0.5) / width - 0.5) * 2 * Math.PI, b = basis([s * Math.sin(a), up, -s * Math.cos(a)]);
            const i = 3 * (y * width + x);
            for (let k = 0; k < 9; k++)
                for (let c = 0; c < 3; c++) sh[k][c] += b[k] * data[i + c] * angle;
        }
    }
    return sh;
}

// ---- a few distant lights: the sphere is halved again and again, each part where its light is halved ----

class Cells {
    constructor(data, side) {
        this.data = data;
        this.side = side;
        let sum = 0;
        for (let i = 0; i < side * side; i++) sum += this.light(i);
        this.floor = sum / (side * side) + 1e-20;
    }

    light(i) {
        return luminance(this.data[4 * i], this.data[4 * i + 1], this.data[4 * i + 2]);
    }

    weight({ x0, y0, x1, y1 }) {
        let sum = 0;
        for (let y = y0; y < y1; y++) for (let x = x0; x < x1; x++) sum += this.light(y * this.side + x) + this.floor;
        return sum;
    }

    // Cuts across the longer side, where the halves weigh most alike; null for a single cell.
    halve(p) {
        const wide = p.x1 - p.x0 >= p.y1 - p.y0, length = wide ? p.x1 - p.x0 : p.y1 - p.y0;
        if (length < 2) return null;
        const half = this.weight(p) / 2, line = (cut) => (wide ? { ...p, x0: p.x0 + cut, x1: p.x0 + cut + 1 } : { ...p, y0: p.y0 + cut, y1: p.y0 + cut + 1 });
        let cut = 0, sum = 0;
        for (; cut < length - 1; cut++) {
            const next = sum + this.weight(line(cut));
            if (cut > 0 && next - half > half - sum) break;
            sum = next;
        }
        return wide ? [{ ...p, x1: p.x0 + cut }, { ...p, x0: p.x0 + cut }] : [{ ...p, y1: p.y0 + cut }, { ...p, y0: p.y0 + cut }];
    }

    lightOf({ x0, y0, x1, y1 }) {
        const angle = SPHERE / (this.side * this.side), power = [0, 0, 0], toward = [0, 0, 0];
        for (let y = y0; y < y1; y++)
            for (let x = x0; x < x1; x++) {
                const i = y * this.side + x, d = octahedronDirection((x + 0.5) / this.side, (y + 0.5) / this.side);
                for (let c = 0; c < 3; c++) {
                    toward[c] += (this.light(i) + 1e-3 * this.floor) * d[c];
                    power[c] += angle * this.data[4 * i + c];
                }
            }
        return { direction: normalized(toward), power, angle: angle * (x1 - x0) * (y1 - y0) };
    }
}

function lightsOf(level) {
    const side = SKY_SIDE >> LIGHTS_LEVEL, cells = new Cells(level, side);
    let parts = [{ x0: 0, y0: 0, x1: side, y1: side }];
    for (let k = 0; k < HALVINGS; k++) parts = parts.flatMap((p) => cells.halve(p) || [p]);
    return parts.map((p) => cells.lightOf(p));
}

// ---- what is made of them ----

function black(value) {
    return value > 0 && value < Infinity ? value : 0;
}

// {levels, sh, lights, mean}: mean is the luminance over the sphere. Impossible values are black.
export function skyOfMap(picture) {
    const map = shrink({ ...picture, data: picture.data.map(black) });
    const levels = halvings(toOctahedron(map)), sh = project(map);
    return { levels, sh, lights: lightsOf(levels[LIGHTS_LEVEL]), mean: luminance(...sh[0]) / Math.sqrt(SPHERE), map };
}

// A picture of coefficients; three bands of a bright sky may be below zero, which is dark.
export function mapOfHarmonics(sh, width = 128, height = 64) {
    const data = new Float32Array(3 * width * height);
    for (let y = 0; y < height; y++)
        for (let x = 0; x < width; x++) {
            const v = (Math.PI * (y + 0.5)) / height, a = ((x + 0.5) / width - 0.5) * 2 * Math.PI, s = Math.sin(v);
            const b = basis([s * Math.sin(a), Math.cos(v), -s * Math.cos(a)]);
            for (let c = 0; c < 3; c++)
                data[3 * (y * width + x) + c] = Math.max(b.reduce((sum, value, k) => sum + value * sh[k][c], 0), 0);
        }
    return { width, height, data };
}

// Turned about the vertical as the map is: ahead to the right at 90 degrees (sh_turn of src/optics/sh.h).
export function turnHarmonics(sh, degrees) {
    const a = (degrees * Math.PI) / 180, c = Math.cos(a), s = Math.sin(a), out = sh.map((v) => [...v]);
    const m = [[c, 0, -s], [0, 1, 0], [s, 0, c]];
    for (let k = 0; k < 3; k++) {
        const line = [sh[3][k], sh[1][k], sh[2][k]];
        const turned = m.map((row) => row[0] * line[0] + row[1] * line[1] + row[2] * line[2]);
        [out[3][k], out[1][k], out[2][k]] = turned;
        const pair = 0.5462742152960396, polar = 0.31539156525252005;
        const q = [[pair * sh[8][k] - polar * sh[6][k], pair * sh[4][k], pair * sh[7][k]],
            [pair * sh[4][k], -pair * sh[8][k] - polar * sh[6][k], pair * sh[5][k]],
            [pair * sh[7][k], pair * sh[5][k], 2 * polar * sh[6][k]]];
        const both = (i, j) => m[i].reduce((sum, x, u) => sum + m[j].reduce((t, y, w) => t + x * q[u][w] * y, 0), 0);
        out[4][k] = both(0, 1) / pair;
        out[5][k] = both(1, 2) / pair;
        out[6][k] = both(2, 2) / (2 * polar);
        out[7][k] = both(0, 2) / pair;
        out[8][k] = (both(0, 0) - both(1, 1)) / (2 * pair);
    }
    return out;
}

// What the clamped cosine keeps of each coefficient's band.
export const COSINE_BANDS = [Math.PI, ...new Array(3).fill((2 * Math.PI) / 3), ...new Array(5).fill(Math.PI / 4)];
