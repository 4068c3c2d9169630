// SPDX-License-Identifier: MIT
// The viewer: what the hands and the panel ask for becomes a state, and the state a picture.
import { Dome } from "./dome.js";
import { startGl } from "./gl.js";
import { Hands, LampHandle, handleDivider } from "./hands.js";
import { Panel } from "./panel.js";
import { readPanorama } from "./panorama.js";
import { encodePng } from "./png.js";
import { LIGHT_POWER, Renderer } from "./renderer.js";
import { MADE, roomMade, roomOfHarmonics, roomOfMap } from "./rooms.js";
import { decodeColor, readAddress, writeAddress } from "./state.js";
import { makeStrip } from "./strip.js";
import { add, clamp, normalized } from "./vector.js";
import { View, rotated, rotationOf, turnedBy, unrotated } from "./view.js";

const SHOWS = { relit: "Relit", shape: "Shape", photo: "Photograph", albedo: "Albedo", normal: "Normals", roughness: "Roughness", depth: "Depth" };
const SWEEP_SECONDS = 3.2, ADDRESS_DELAY = 400, SAY_DELAY = 500, TROUBLE_SECONDS = 12;
const get = (id) => document.getElementById(id);

export class Viewer {
    constructor(scene, canvas) {
        this.scene = scene;
        this.canvas = canvas;
        this.shows = Object.keys(SHOWS).filter((s) => (s !== "photo" || scene.photo) && (s !== "roughness" || !scene.matte));
        this.state = readAddress(location.hash, this.shows, this.roomKinds());
        this.gl = startGl(canvas);
        this.renderer = new Renderer(this.gl, scene);
        this.dome = new Dome(this.renderer.camera);
        this.view = new View(scene.side);
        this.wanted = { picture: true, panel: true };
        this.settleState();
        if (this.state.bare) document.documentElement.classList.add("bare");
        this.hands = new Hands(this, canvas);
        this.handles = [0, 1].map((i) => new LampHandle(this, i, get(`lamp-${i}`)));
        this.panel = new Panel(this);
        this.wire();
    }

    // What the scene has to say of a state that was read.
    settleState() {
        if (!this.scene.photo) this.state.compare = null;
        for (const lamp of this.state.lamps) lamp.height = lamp.far ? 1 : this.dome.heightOf(lamp.at);
    }

    roomKinds() {
        return [...Object.keys(MADE), ...(this.scene.light ? ["found"] : [])];
    }

    wire() {
        handleDivider(this, get("divider"));
        const on = (id, does) => get(id).addEventListener("click", does);
        on("compare", () => this.compare());
        on("turn", () => this.turnAbout());
        on("save", () => this.save());
        on("help", () => this.help());
        on("zoom-in", () => this.zoom(1.5));
        on("zoom-out", () => this.zoom(1 / 1.5));
        on("zoom-fit", () => this.zoom(0));
        on("zoom-level", () => this.zoomToPixels());
        get("compare").hidden = !this.scene.photo;
        new ResizeObserver(() => this.resize()).observe(this.state.bare ? document.documentElement : get("stage"));
        addEventListener("hashchange", () => this.readAgain());
        this.canvas.addEventListener("webglcontextlost", () => this.trouble("The graphics driver gave up. Load the page again."));
        this.takeDrops();
    }

    takeDrops() {
        const over = (event) => {
            if (![...event.dataTransfer.types].includes("Files")) return;
            event.preventDefault();
            get("drop").hidden = false;
        };
        addEventListener("dragenter", over);
        addEventListener("dragover", over);
        addEventListener("dragleave", (event) => (get("drop").hidden = !event.relatedTarget ? true : get("drop").hidden));
        addEventListener("drop", (event) => {
            event.preventDefault();
            get("drop").hidden = true;
            if (event.dataTransfer.files[0]) this.takePanorama(event.dataTransfer.files[0]);
        });
    }

    async start() {
        const { name, photograph, side, matte } = this.scene, size = `${photograph.width} × ${photograph.height}`;
        document.title = `${name} – merlin`;
        get("name").textContent = name;
        get("facts").textContent = `${matte ? "a captured surface" : "a photograph"}, ${size}${side < photograph.side ? `, here ${side} pixels a side` : ""}`;
        this.setRoom(this.state.room.kind, true);
        this.resize();
        if (!this.state.bare) makeStrip(this, SHOWS);
        if (!this.state.bare) this.welcome();
        this.draw();
    }

    // ---- drawing ----

    resize() {
        const box = this.canvas.getBoundingClientRect(), ratio = this.state.bare ? 1 : devicePixelRatio || 1;
        if (this.state.bare) {
            this.canvas.width = this.canvas.height = this.scene.side;
            this.renderer.backdrop = [0, 0, 0];
        } else {
            this.canvas.width = Math.max(Math.round(box.width * ratio), 1);
            this.canvas.height = Math.max(Math.round(box.height * ratio), 1);
        }
        this.view.resize(this.canvas.width, this.canvas.height, ratio);
        if (this.state.bare) Object.assign(this.view, { scale: 1, x: 0, y: 0 });
        this.draw({ picture: false });
    }

    // Asks for a frame.
    draw({ picture = true, panel = true } = {}) {
        this.wanted.picture ||= picture;
        this.wanted.panel ||= panel;
        if (this.asked) return;
        this.asked = true;
        requestAnimationFrame(() => this.frame());
    }

    frame() {
        this.asked = false;
        const { picture, panel } = this.wanted, state = this.state, room = this.renderer.room;
        this.wanted = { picture: false, panel: false };
        if (this.gl.isContextLost()) return;
        const refining = this.lightsRoom() && room.refine(state.bare), light = this.light();
        if (picture || this.refining) if (!state.solid || !this.isLit()) this.renderer.draw(state.show, light);
        if (state.solid) this.renderer.displayMesh(this.view, rotationOf(state.solid), light, !this.isLit());
        else this.renderer.display({ ...this.view, divider: state.compare === null ? -1 : state.compare * this.view.width });
        if (!state.bare) this.placeHandles();
        if (panel && !state.bare) this.showPanel();
        this.refining = refining;
        if (refining) this.draw({ panel: false });
    }

    lightsRoom() {
        return this.sky && this.state.room.kind !== "none" && this.isLit();
    }

    // The light as the renderer takes it; show: what is lit.
    light(show = this.state.show) {
        const state = this.state, scale = 2 ** state.room.ev, found = state.room.kind === "found" ? this.scene.light.lamps : [];
        const lamps = state.lamps.filter((l) => l.on).map((l) => ({
            at: l.at, far: l.far, light: decodeColor(l.color).map((c) => c * l.power * LIGHT_POWER),
        }));
        for (const lamp of found)
            lamps.push({ at: this.turnedLamp(lamp), far: lamp.distant, light: lamp.tint.map((c) => c * LIGHT_POWER * scale) });
        return {
            lamps, white: this.scene.white / 2 ** state.ev, plain: show === "shape",
            room: this.lightsRoom() ? [scale, scale, scale] : null,
        };
    }

    // All that was found but a flash at the lens turns about the object's middle.
    turnedLamp(lamp) {
        if (lamp.fixed) return lamp.at;
        const a = (this.state.room.turn * Math.PI) / 180, c = Math.cos(a), s = Math.sin(a), about = lamp.distant ? 0 : -1;
        const [x, y, z] = [lamp.at[0], lamp.at[1], lamp.at[2] - about];
        return [c * x - s * z, y, s * x + c * z + about];
    }

    isLit() {
        return this.state.show === "relit" || this.state.show === "shape";
    }

    showPanel() {
        const state = this.state, pressed = (id, on) => get(id).setAttribute("aria-pressed", String(on));
        this.panel.show(state);
        pressed("compare", state.compare !== null);
        pressed("turn", Boolean(state.solid));
        get("zoom-level").textContent = `${Math.round((100 * this.view.scale) / this.view.ratio)} %`;
        this.canvas.classList.toggle("plain", !this.isLit());
        const divider = get("divider");
        divider.hidden = state.compare === null || Boolean(state.solid);
        if (state.compare !== null) {
            divider.style.left = `${100 * state.compare}%`;
            divider.setAttribute("aria-valuenow", Math.round(100 * state.compare));
            divider.setAttribute("aria-valuetext", `${Math.round(100 * state.compare)} % photograph`);
        }
        if (this.strip) this.strip.choose(state.show);
        clearTimeout(this.writing);
        this.writing = setTimeout(() => this.writeAddress(), ADDRESS_DELAY);
    }

    // ---- where lamps are ----

    // Into the space that the screen shows, and back.
    toShown(p) {
        if (!this.state.solid) return p;
        const m = this.renderer.middle(), from = [p[0], p[1], p[2] - m[2]];
        return add(rotated(rotationOf(this.state.solid), from), m);
    }

    fromShown(p) {
        if (!this.state.solid) return p;
        const m = this.renderer.middle(), from = [p[0], p[1], p[2] - m[2]];
        return add(unrotated(rotationOf(this.state.solid), from), m);
    }

    // A lamp as a place on the dome, that of a distant one at its direction.
    placeOf(lamp) {
        return this.toShown(lamp.far ? add(lamp.at, [0, 0, -1]) : lamp.at);
    }

    setPlace(i, shown) {
        const lamp = this.state.lamps[i], place = this.fromShown(shown);
        lamp.at = lamp.far ? normalized(add(place, [0, 0, 1])) : place;
    }

    placeHandles() {
        for (const i of [0, 1]) {
            const lamp = this.state.lamps[i], element = get(`lamp-${i}`), shown = this.placeOf(lamp);
            element.hidden = !lamp.on || !this.isLit();
            if (element.hidden) continue;
            const [u, v] = this.dome.under(shown), [x, y] = this.view.screenAt(this.renderer.camera.place([u, v, -1]));
            element.style.left = `${clamp(x, 0, this.view.width) / this.view.ratio}px`;
            element.style.top = `${clamp(y, 0, this.view.height) / this.view.ratio}px`;
            element.style.setProperty("--color", lamp.color);
            element.classList.toggle("held", this.state.held && i === this.state.chosen);
            element.classList.toggle("behind", shown[2] < -1);
            element.setAttribute("aria-label", `Lamp ${i + 1}: ${this.wordsOf(shown, lamp.far)}`);
        }
    }

    wordsOf([x, y, z], far) {
        const side = x > 0.08 ? "right" : x < -0.08 ? "left" : "", level = y > 0.08 ? "upper" : y < -0.08 ? "lower" : "";
        const where = side || level ? `from the ${[level, side].filter(Boolean).join(" ")}` : "from the front";
        return `${where}, height ${(z + 1).toFixed(2)}${far ? ", far away" : ""}`;
    }

    // ---- what is asked for ----

    change(does) {
        does(this.state);
        this.draw();
    }

    lightAt(i, [x, y]) {
        const ray = this.renderer.camera.ray(this.view.placeAt(x, y));
        this.setPlace(i, this.dome.lampOver(ray, this.state.lamps[i].height));
        this.draw();
    }

    // By a distance in the plane at depth 1.
    nudge(i, right, up) {
        const lamp = this.state.lamps[i], [x, y] = this.dome.under(this.placeOf(lamp));
        this.state.held = true;
        this.setPlace(i, this.dome.lampOver([x + right, y + up], lamp.height));
        this.announceLamp(i);
        this.draw();
    }

    setHeight(i, height) {
        const lamp = this.state.lamps[i];
        lamp.height = height;
        this.setPlace(i, this.dome.raised(this.placeOf(lamp), height));
        this.draw();
    }

    raise(i, by) {
        this.setHeight(i, clamp(this.state.lamps[i].height + by, 0.05, 2));
        this.announceLamp(i);
    }

    strengthen(i, factor) {
        this.change((s) => (s.lamps[i].power = clamp(s.lamps[i].power * factor, 1 / 32, 32)));
        this.say(`Strength ${this.state.lamps[i].power.toFixed(2)}`);
    }

    setFar(i, far) {
        const lamp = this.state.lamps[i], place = this.placeOf(lamp);
        lamp.far = far;
        this.setPlace(i, place);
        this.draw();
    }

    announceLamp(i) {
        const lamp = this.state.lamps[i];
        this.say(this.wordsOf(this.placeOf(lamp), lamp.far), SAY_DELAY);
    }

    choose(i, on = false) {
        if (on && i === 1 && !this.state.lamps[1].on) this.state.lamps[1].on = true;
        if (i !== this.state.chosen || on) this.change((s) => (s.chosen = i));
    }

    switchLamp(i, on = !this.state.lamps[i].on) {
        this.change((s) => {
            s.lamps[i].on = on;
            s.chosen = on || i === 0 ? i : 0;
        });
        this.say(`Lamp ${i + 1} ${on ? "on" : "off"}`);
    }

    hold() {
        this.change((s) => (s.held = !s.held));
        this.say(this.state.held ? "The lamp stays" : "The lamp follows the pointer");
    }

    show(what) {
        this.change((s) => (s.show = what));
    }

    showNext(by) {
        const i = this.shows.indexOf(this.state.show);
        this.show(this.shows[(i + by + this.shows.length) % this.shows.length]);
        this.say(SHOWS[this.state.show]);
    }

    compare() {
        if (!this.scene.photo) return;
        this.change((s) => {
            s.compare = s.compare === null ? 0.5 : null;
            s.solid = null;
        });
    }

    divide(share) {
        this.state.compare = share;
        this.draw({ picture: false });
    }

    turnAbout() {
        this.change((s) => {
            s.solid = s.solid ? null : { yaw: -25, pitch: 8 };
            s.compare = null;
        });
    }

    turnBy(right, down) {
        this.turnTo(turnedBy(this.state.solid, right, down));
    }

    turnTo(solid) {
        this.state.solid = solid;
        this.draw({ picture: false });
    }

    zoom(factor, x, y) {
        if (factor === 0) this.view.fit();
        else this.view.zoomBy(factor, x, y);
        this.draw({ picture: false });
    }

    zoomToPixels() {
        this.zoom(this.view.ratio / this.view.scale);
    }

    pan(dx, dy) {
        this.view.move(dx, dy);
        this.draw({ picture: false, panel: false });
    }

    help() {
        get("help-text").showModal();
    }

    // ---- rooms ----

    setRoom(kind, first = false) {
        if (kind === "panorama" && !this.panorama) kind = first ? "none" : this.state.room.kind;
        const state = this.state, told = state.room.sh, was = state.room.kind;
        if (kind === "found") this.sky = roomOfHarmonics(this.scene.light.rest);
        else if (kind === "sh") this.sky = { ...roomOfHarmonics(told), told };
        else if (kind === "panorama") this.sky = this.panorama.sky;
        else this.sky = kind === "none" ? null : roomMade(kind);
        if (kind === "found" && was !== "found") for (const lamp of state.lamps) lamp.on = false;
        if (kind !== "found" && was === "found" && !state.lamps.some((l) => l.on)) state.lamps[0].on = true;
        state.room.kind = kind;
        this.renderer.room.take(this.sky);
        this.turnRoom(state.room.turn);
    }

    setHarmonics(sh) {
        this.state.room.sh = sh;
        this.setRoom("sh");
    }

    turnRoom(degrees) {
        this.state.room.turn = degrees;
        this.renderer.room.turn(degrees);
        this.draw();
    }

    async takePanorama(file) {
        this.trouble("");
        this.say(`Reading ${file.name}`);
        try {
            const map = await readPanorama(file);
            this.panorama = { name: file.name, sky: roomOfMap(map) };
            this.setRoom("panorama");
            this.say(`${file.name} lights the object`);
        } catch (error) {
            this.trouble(error.message);
        }
    }

    // ---- words ----

    say(words, delay = 0) {
        clearTimeout(this.saying);
        this.saying = setTimeout(() => (get("said").textContent = words), delay);
    }

    trouble(words) {
        get("trouble").hidden = !words;
        get("trouble").textContent = words;
        clearTimeout(this.forgetting);
        if (words) this.forgetting = setTimeout(() => this.trouble(""), TROUBLE_SECONDS * 1000);
    }

    // The maps at a place of the screen.
    tell(at) {
        const values = get("values"), side = this.scene.side, shown = !this.state.solid && (!this.isLit() || this.view.scale >= 4 * this.view.ratio);
        const [u, v] = at ? this.view.placeAt(...at) : [-1, -1], x = Math.floor(u * side), y = Math.floor(v * side);
        const maps = shown && x >= 0 && y >= 0 && x < side && y < side && this.scene.at(x, y);
        const three = (list) => list.map((value) => value.toFixed(2)).join(" ");
        values.textContent = !maps ? ""
            : `${x}, ${y}   albedo ${three(maps.albedo)}   normal ${three(maps.normal)}${maps.roughness === null ? "" : `   roughness ${maps.roughness.toFixed(2)}`}   depth ${maps.depth.toFixed(3)}`;
    }

    // The lamp sweeps once over the object, so that it is seen what the page does; and a hint says how.
    welcome() {
        const touch = matchMedia("(pointer: coarse)").matches, hint = get("hint");
        hint.textContent = touch ? "Drag to light · two fingers zoom" : "Move to light · click to hold · wheel to zoom";
        hint.hidden = false;
        this.sweeping = !this.state.held && !matchMedia("(prefers-reduced-motion: reduce)").matches;
        const { at: to, height } = this.state.lamps[0], began = performance.now(), [x, y] = this.dome.under(to);
        const step = (now) => {
            const t = clamp((now - began) / 1000 / SWEEP_SECONDS, 0, 1), ease = t * t * (3 - 2 * t), a = 1.1 * Math.PI * (1 - ease) * (1 - ease);
            if (!this.sweeping) return;
            this.setPlace(0, this.dome.lampOver([x * Math.cos(a) - y * Math.sin(a), x * Math.sin(a) + y * Math.cos(a)], height));
            this.draw();
            if (t < 1) requestAnimationFrame(step);
        };
        if (this.sweeping) requestAnimationFrame(step);
    }

    // Somebody is there.
    wake() {
        this.sweeping = false;
        const hint = get("hint");
        if (hint.hidden || hint.classList.contains("gone")) return;
        setTimeout(() => hint.classList.add("gone"), 2500);
    }

    // ---- out of the page ----

    async save() {
        const side = this.scene.side, name = `${this.scene.name}-${this.state.solid ? "turned" : this.state.show}.png`;
        const blob = this.state.solid ? await this.screenPng() : await encodePng(this.renderer.bytes(), side, side);
        const link = Object.assign(document.createElement("a"), { href: URL.createObjectURL(blob), download: name });
        link.click();
        setTimeout(() => URL.revokeObjectURL(link.href), 10000);
        this.say(`Saved ${name}`);
    }

    // What is on the screen.
    screenPng() {
        const gl = this.gl, { width, height } = this.canvas, from = new Uint8Array(4 * width * height), rows = new Uint8Array(from.length);
        this.renderer.displayMesh(this.view, rotationOf(this.state.solid), this.light(), !this.isLit());
        gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, from);
        for (let y = 0; y < height; y++) rows.set(from.subarray(4 * width * y, 4 * width * (y + 1)), 4 * width * (height - 1 - y));
        return encodePng(rows, width, height);
    }

    writeAddress() {
        const hash = writeAddress(this.state);
        if (this.sweeping || hash === location.hash) return;
        try {
            history.replaceState(null, "", hash);
        } catch {
            // a page from the disk may not be allowed to
        }
    }

    readAgain() {
        const { bare } = this.state;
        this.state = { ...readAddress(location.hash, this.shows, this.roomKinds()), bare };
        this.settleState();
        this.setRoom(this.state.room.kind, true);
    }
}
