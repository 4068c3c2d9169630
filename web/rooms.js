// SPDX-License-Identifier: MIT
// Rooms: some made of nine spherical harmonics, the light that was found in the photograph, and panoramas.
import { basis, mapOfHarmonics, skyOfMap } from "./sky.js";
import { normalized } from "./vector.js";

// Coefficients of the radiance a + b cos + c (3 cos² - 1)/2 about a direction, times a colour.
function lobe(toward, [a, b, c], color) {
    const n = basis(normalized(toward)), band = [4 * Math.PI * a, ...new Array(3).fill((4 * Math.PI * b) / 3), ...new Array(5).fill((4 * Math.PI * c) / 5)];
    return n.map((value, k) => color.map((channel) => value * band[k] * channel));
}

const sum = (...parts) => parts[0].map((_, k) => [0, 1, 2].map((c) => parts.reduce((s, p) => s + p[k][c], 0)));

// How the made ones are called, and their coefficients.
export const MADE = {
    overcast: ["Overcast", lobe([0, 1, 0.2], [1, 0.75, 0.1], [0.95, 1, 1.08])],
    window: ["Window", sum(lobe([-0.85, 0.35, 0.45], [0.6, 0.9, 0.45], [0.95, 1, 1.1]), lobe([1, 0, 0], [0.15, 0, 0], [1.1, 1, 0.85]))],
    evening: ["Evening", sum(lobe([0.9, 0.15, 0.35], [0.6, 0.85, 0.4], [1.5, 0.85, 0.4]), lobe([-0.3, 1, 0], [0.3, 0.25, 0], [0.5, 0.8, 1.5]))],
};

const luminance = ([r, g, b]) => 0.2126 * r + 0.7152 * g + 0.0722 * b;

// A mean luminance of 1 at 0 EV, as of merlin relight --env.
function scaledTo(sky, scale) {
    for (const level of sky.levels) for (let i = 0; i < level.length; i++) level[i] *= scale;
    sky.sh = sky.sh.map((v) => v.map((x) => x * scale));
    for (const light of sky.lights) light.power = light.power.map((x) => x * scale);
    sky.mean *= scale;
    return sky;
}

export function roomOfMap(map) {
    const sky = skyOfMap(map);
    return scaledTo(sky, 1 / sky.mean);
}

// As they are told.
export function roomOfHarmonics(sh) {
    return skyOfMap(mapOfHarmonics(sh));
}

export function roomMade(name) {
    const sh = MADE[name][1], scale = Math.sqrt(4 * Math.PI) / luminance(sh[0]);
    return roomOfHarmonics(sh.map((v) => v.map((x) => x * scale)));
}

// Nine rows of red, green, blue, in any layout; null for what is not 27 numbers.
export function readHarmonics(text) {
    const numbers = text.split(/[\s,;]+/).filter((word) => word !== "").map(Number);
    if (numbers.length !== 27 || !numbers.every(Number.isFinite)) return null;
    return Array.from({ length: 9 }, (_, k) => numbers.slice(3 * k, 3 * k + 3));
}

export function writeHarmonics(sh) {
    return sh.map((row) => row.map((x) => Number(x.toPrecision(4))).join(" ")).join("\n");
}
