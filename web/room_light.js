// SPDX-License-Identifier: MIT
// The light of a room on the surface, with the shadows that it casts on itself: worked out when the room or its turn
// changes, first coarsely and then, a few rows a frame, in full.
import { Program, fill, fillLevel, makeTarget, makeTexture } from "./gl.js";
import { COSINE_BANDS, SKY_LEVELS, SKY_SIDE, turnHarmonics } from "./sky.js";

const AZIMUTHS = 24, MOST_HORIZON = 256, MOST_LIGHTS = 256, RADIUS_SHARE = 24, PLACES = 64;
const SURFACE = ["surface.glsl", "camera.glsl"], WHOLE = ["whole.vert.glsl"];
// Milliseconds that drawing may take of a frame, and how many pixels a side are one at first.
const BUDGET = 12, COARSER = 4;

// Hammersley's points: even steps one way, bits of the number reversed the other way.
function lobePlaces() {
    const out = [];
    for (let i = 0; i < PLACES; i++) {
        let turn = 0;
        for (let bits = i, half = 0.5; bits; bits >>= 1, half /= 2) if (bits & 1) turn += half;
        const phi = 2 * Math.PI * (turn + 0.5 / PLACES);
        out.push((i + 0.5) / PLACES, Math.cos(phi), Math.sin(phi));
    }
    return out;
}

export class RoomLight {
    constructor(gl, scene, shared) {
        this.gl = gl;
        this.scene = scene;
        this.shared = shared;
        this.places = lobePlaces();
        this.none = makeTexture(gl, "rgba16f", 1, 1, { smooth: true });
        this.next = 0; // the row to go on at
    }

    // What only rooms need is made when the first one comes.
    prepare() {
        if (this.programs) return;
        const gl = this.gl, scene = this.scene, low = scene.low, target = (smooth) => makeTarget(gl, [makeTexture(gl, "rgba16f", low, low, { smooth })]);
        this.programs = {
            horizon: new Program(gl, WHOLE, ["camera.glsl", "sight.glsl", "horizon.frag.glsl"]),
            low: new Program(gl, WHOLE, [...SURFACE, "low.frag.glsl"]),
            arriving: new Program(gl, WHOLE, ["camera.glsl", "sight.glsl", "seen_sky.glsl", "arriving.frag.glsl"]),
            nearby: new Program(gl, WHOLE, ["harmonics.glsl", "lit_nearby.frag.glsl"]),
            bounce: new Program(gl, WHOLE, ["harmonics.glsl", "bounce.frag.glsl"]),
            room: new Program(gl, WHOLE, [...SURFACE, "sight.glsl", "seen_sky.glsl", "harmonics.glsl", "room.frag.glsl"]),
        };
        const side = scene.side, few = Math.max(Math.ceil(side / COARSER), 1);
        this.whole = makeTarget(gl, [makeTexture(gl, "rgba16f", side, side, { smooth: true })]);
        this.coarse = makeTarget(gl, [makeTexture(gl, "rgba16f", few, few, { smooth: true })]);
        this.low = makeTarget(gl, [makeTexture(gl, "rgba16f", low, low), makeTexture(gl, "rgba16f", low, low)]);
        fill(gl, this.low, this.programs.low, { ...this.shared, step_size: scene.side / low });
        this.share = target(false);
        this.along = target(false);
        this.sums = target(false);
        this.arrives = target(true);
        this.sky = makeTexture(gl, "rgba32f", SKY_SIDE, SKY_SIDE, { levels: SKY_LEVELS });
        this.lights = makeTexture(gl, "rgba32f", MOST_LIGHTS, 2);
        this.makeHorizon();
    }

    makeHorizon() {
        const gl = this.gl, side = Math.min(this.scene.caster.side, MOST_HORIZON);
        this.horizon = makeTexture(gl, "rg32ui", side, side, { layers: AZIMUTHS });
        for (let azimuth = 0; azimuth < AZIMUTHS; azimuth++) {
            const layer = makeTarget(gl, [this.horizon], azimuth);
            fill(gl, layer, this.programs.horizon, { ...this.shared, azimuth, step_size: this.scene.caster.side / side });
            gl.deleteFramebuffer(layer.handle);
        }
    }

    // Another room, or null.
    take(sky) {
        this.given = sky;
        if (!sky) return;
        this.prepare();
        sky.levels.forEach((level, i) => fillLevel(this.gl, this.sky, "rgba32f", i, level));
        const data = new Float32Array(8 * MOST_LIGHTS);
        sky.lights.forEach((l, i) => {
            data.set([...l.direction, l.angle], 4 * i);
            data.set([...l.power, 0], 4 * (MOST_LIGHTS + i));
        });
        fillLevel(this.gl, this.lights, "rgba32f", 0, data);
    }

    // Begins to draw it as it is when it is turned by so many degrees.
    turn(degrees) {
        if (!this.given) return;
        const gl = this.gl, [albedo, normal] = this.low.textures, radius = Math.floor(this.scene.low / RADIUS_SHARE);
        const a = (degrees * Math.PI) / 180, sh = turnHarmonics(this.given.sh, degrees);
        this.uniforms = {
            ...this.shared, low_albedo: albedo, low_normal: normal, horizon: this.horizon, lights: this.lights,
            light_count: this.given.lights.length, turn: [Math.cos(a), Math.sin(a)], sky: this.sky, places: this.places,
            sh: sh.flatMap((v, i) => v.map((x) => x * COSINE_BANDS[i])),
            share: this.share.textures[0], arriving: this.arrives.textures[0],
        };
        fill(gl, this.share, this.programs.arriving, this.uniforms);
        fill(gl, this.along, this.programs.nearby, { ...this.uniforms, first: true, radius, sums: this.sums.textures[0] });
        fill(gl, this.sums, this.programs.nearby, { ...this.uniforms, first: false, radius, sums: this.along.textures[0] });
        fill(gl, this.arrives, this.programs.bounce, { ...this.uniforms, sums: this.sums.textures[0] });
        fill(gl, this.coarse, this.programs.room, { ...this.uniforms, stride: COARSER });
        this.next = 0;
        this.rows = 16;
    }

    // Draws further rows; true while some are left.
    refine(all = false) {
        const side = this.scene.side, began = performance.now();
        while (this.given && this.next < side && (all || performance.now() - began < BUDGET)) {
            const end = Math.min(this.next + this.rows, side), before = performance.now();
            fill(this.gl, this.whole, this.programs.room, { ...this.uniforms, stride: 1 }, [this.next, end]);
            if (!all) this.wait(end - 1);
            const took = performance.now() - before;
            this.rows = Math.max(4, Math.min(side, took < BUDGET / 4 ? 2 * this.rows : took > BUDGET ? this.rows >> 1 : this.rows));
            this.next = end;
        }
        return Boolean(this.given) && this.next < side;
    }

    // Until a row is drawn.
    wait(row) {
        const gl = this.gl;
        gl.bindFramebuffer(gl.FRAMEBUFFER, this.whole.handle);
        gl.readPixels(0, row, 1, 1, gl.RGBA, gl.FLOAT, new Float32Array(4));
        gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    }

    texture() {
        if (!this.programs) return this.none;
        return (this.next < this.scene.side ? this.coarse : this.whole).textures[0];
    }
}
