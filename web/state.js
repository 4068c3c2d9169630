// SPDX-License-Identifier: MIT
// What is shown and how it is lit; as words behind # in the page's address, which has the names of merlin relight's
// options; and as a command of merlin relight.
import { readHarmonics, writeHarmonics } from "./rooms.js";
import { clamp } from "./vector.js";

const START = [-0.45, 0.5, -0.3], SECOND = [0.7, 0.1, -0.45];

export function newState() {
    const lamp = (on, at, color) => ({ on, at, far: false, color, power: 1 });
    return {
        show: "relit", // relit, shape, photo, albedo, normal, roughness, depth
        lamps: [lamp(true, START, "#ffffff"), lamp(false, SECOND, "#ffd2a1")],
        chosen: 0,
        held: false, // the lamp stays where it is
        room: { kind: "none", turn: 0, ev: 0, sh: null }, // none, found, made ones, sh, panorama
        ev: 0,
        compare: null, // where the divider is, 0 to 1
        solid: null, // turned about: {yaw, pitch} in degrees
        bare: false, // the picture alone, its pixels the screen's
    };
}

export function decodeColor(hex) {
    return [1, 3, 5].map((i) => {
        const x = parseInt(hex.slice(i, i + 2), 16) / 255;
        return x <= 0.04045 ? x / 12.92 : ((x + 0.055) / 1.055) ** 2.4;
    });
}

// ---- the address ----

function numbers(text, count) {
    const list = (text || "").split(",").map(Number);
    return list.length === count && list.every(Number.isFinite) ? list : null;
}

function readLamp(words, suffix, lamp) {
    const near = numbers(words.get(`light${suffix}`), 3), far = numbers(words.get(`direction${suffix}`), 3);
    if (near || (far && Math.hypot(...far) > 0)) {
        lamp.on = true;
        lamp.far = !near;
        lamp.at = near || far.map((x) => x / Math.hypot(...far));
    }
    const power = numbers(words.get(`power${suffix}`), 1), color = words.get(`color${suffix}`);
    if (power && power[0] > 0) lamp.power = power[0];
    if (/^#[0-9a-f]{6}$/i.test(color || "")) lamp.color = color.toLowerCase();
}

// Words that mean nothing are left out of account.
export function readAddress(hash, shows, rooms) {
    const state = newState(), words = new URLSearchParams(hash.replace(/^#/, "").replace(/=#/g, "=%23"));
    if (words.get("light") === "none") state.lamps[0].on = false;
    readLamp(words, "", state.lamps[0]);
    readLamp(words, "2", state.lamps[1]);
    const one = (name, low, high, fallback) => {
        const value = numbers(words.get(name), 1);
        return value ? clamp(value[0], low, high) : fallback;
    };
    state.held = words.has("light") || words.has("direction");
    if (rooms.includes(words.get("env"))) state.room.kind = words.get("env");
    const sh = readHarmonics(words.get("sh") || "");
    if (sh) Object.assign(state.room, { kind: "sh", sh });
    state.room.turn = one("rotate", -1e6, 1e6, 0);
    state.room.ev = one("env-exposure", -20, 20, 0);
    state.ev = one("exposure", -20, 20, 0);
    if (shows.includes(words.get("show"))) state.show = words.get("show");
    if (words.has("compare")) state.compare = one("compare", 0, 1, 0.5);
    const turned = numbers(words.get("turned"), 2);
    if (turned) state.solid = { yaw: turned[0], pitch: turned[1] };
    state.bare = words.has("bare");
    return state;
}

const short = (x) => Number(x.toFixed(3));

function writeLamp(lamp, suffix, words) {
    words.push(`${lamp.far ? "direction" : "light"}${suffix}=${lamp.at.map(short).join(",")}`);
    if (lamp.power !== 1) words.push(`power${suffix}=${short(lamp.power)}`);
    if (lamp.color !== "#ffffff") words.push(`color${suffix}=${lamp.color.replace("#", "%23")}`);
}

export function writeAddress(state) {
    const words = [];
    if (state.lamps[0].on) writeLamp(state.lamps[0], "", words);
    else words.push("light=none");
    if (state.lamps[1].on) writeLamp(state.lamps[1], "2", words);
    if (state.room.kind === "sh") words.push(`sh=${writeHarmonics(state.room.sh).replace(/\s+/g, ",")}`);
    else if (state.room.kind !== "none" && state.room.kind !== "panorama") words.push(`env=${state.room.kind}`);
    if (state.room.turn) words.push(`rotate=${short(state.room.turn)}`);
    if (state.room.ev) words.push(`env-exposure=${short(state.room.ev)}`);
    if (state.ev) words.push(`exposure=${short(state.ev)}`);
    if (state.show !== "relit") words.push(`show=${state.show}`);
    if (state.compare !== null) words.push(`compare=${short(state.compare)}`);
    if (state.solid) words.push(`turned=${short(state.solid.yaw)},${short(state.solid.pitch)}`);
    return `#${words.join("&")}`;
}

// ---- the command ----

function quoted(word) {
    return /^[\w./:-]+$/.test(word) ? word : `'${word.replace(/'/g, "'\\''")}'`;
}

// What makes the same picture at the command line; null for what merlin relight has no words for.
export function commandOf(state, scene, panorama) {
    const on = state.lamps.filter((lamp) => lamp.on), kind = state.room.kind, words = ["merlin relight", quoted(scene.folder)];
    if (!["relit"].includes(state.show) || on.length > 1 || (on.length === 0 && kind === "none")) return null;
    if (kind === "found" ? on.length > 0 : !["none", "panorama"].includes(kind)) return null;
    for (const lamp of on) {
        words.push(`--${lamp.far ? "direction" : "light"}`, lamp.at.map(short).join(","));
        if (lamp.power !== 1) words.push("--power", short(lamp.power));
        if (lamp.color !== "#ffffff") words.push("--color", `'${lamp.color}'`);
    }
    if (on.length > 0 || kind === "found") words.push("--no-bounces");
    if (kind === "panorama") words.push("--env", quoted(panorama));
    if (kind === "panorama" && state.room.ev) words.push("--env-exposure", short(state.room.ev));
    if (kind === "found" && state.room.ev) return null;
    if (kind === "found") words.push("--found-light");
    if (kind !== "none" && state.room.turn) words.push("--rotate", short(state.room.turn));
    const ev = state.ev + scene.ev;
    if (Math.abs(ev) >= 0.0005 || scene.metered) words.push("--exposure", short(ev));
    return words.join(" ");
}
