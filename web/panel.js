// SPDX-License-Identifier: MIT
// The controls beside the picture: they tell `viewer` what is wanted, and show what is.
import { MADE, readHarmonics, writeHarmonics } from "./rooms.js";
import { commandOf } from "./state.js";

const COLORS = [["#ffffff", "White"], ["#ffd2a1", "Halogen"], ["#ffae62", "Bulb"], ["#ff8a33", "Candle"], ["#c9dcff", "Sky"]];
const get = (id) => document.getElementById(id);
const twoDigits = (x) => (Math.abs(x) >= 9.95 ? x.toFixed(0) : Math.abs(x) >= 0.995 ? x.toFixed(1) : x.toFixed(2));
const signed = (x) => `${x > 0.005 ? "+" : ""}${x.toFixed(1)} EV`;

export class Panel {
    constructor(viewer) {
        this.viewer = viewer;
        this.makeColors();
        this.makeRooms();
        for (const i of [0, 1]) get(`choose-${i}`).addEventListener("click", () => viewer.choose(i, true));
        this.on("lamp-on", "change", (e) => viewer.switchLamp(viewer.state.chosen, e.checked));
        this.on("far", "change", (e) => viewer.setFar(viewer.state.chosen, e.checked));
        this.on("height", "input", (e) => viewer.setHeight(viewer.state.chosen, Number(e.value)));
        this.on("power", "input", (e) => viewer.change((s) => (s.lamps[s.chosen].power = 2 ** Number(e.value))));
        this.on("ev", "input", (e) => viewer.change((s) => (s.ev = Number(e.value))));
        this.on("room-ev", "input", (e) => viewer.change((s) => (s.room.ev = Number(e.value))));
        this.on("room-turn", "input", (e) => viewer.turnRoom(Number(e.value)));
        this.on("harmonics", "input", (e) => this.takeHarmonics(e));
        this.on("file", "change", (e) => e.files[0] && viewer.takePanorama(e.files[0]));
        this.on("copy", "click", () => this.copy());
        this.dragSky(get("sky"));
    }

    on(id, event, does) {
        get(id).addEventListener(event, (e) => does(e.currentTarget));
    }

    makeColors() {
        const viewer = this.viewer, box = get("colors"), set = (color) => viewer.change((s) => (s.lamps[s.chosen].color = color));
        this.swatches = COLORS.map(([color, name]) => {
            const button = Object.assign(document.createElement("button"), { type: "button", title: name });
            button.setAttribute("aria-label", name);
            button.style.setProperty("--color", color);
            button.addEventListener("click", () => set(color));
            box.append(button);
            return [button, color];
        });
        this.anyColor = Object.assign(document.createElement("input"), { type: "color", title: "Any colour" });
        this.anyColor.setAttribute("aria-label", "Any colour");
        this.anyColor.addEventListener("input", () => set(this.anyColor.value));
        box.append(this.anyColor);
    }

    makeRooms() {
        const viewer = this.viewer, found = viewer.scene.light ? [["found", "As found"]] : [];
        const rooms = [["none", "Dark"], ...found, ...Object.entries(MADE).map(([key, [name]]) => [key, name]), ["sh", "Own"], ["panorama", ""]];
        this.rooms = new Map(rooms.map(([kind, name]) => {
            const label = document.createElement("label"), input = document.createElement("input"), words = document.createElement("span");
            Object.assign(input, { type: "radio", name: "room", value: kind });
            words.textContent = name;
            label.append(input, words);
            input.addEventListener("change", () => viewer.setRoom(kind));
            get("open-file").before(label);
            return [kind, input];
        }));
        this.on("open-file", "click", () => get("file").click());
    }

    takeHarmonics(area) {
        const sh = readHarmonics(area.value);
        area.setAttribute("aria-invalid", String(!sh));
        if (sh) this.viewer.setHarmonics(sh);
    }

    // The room's picture is turned by dragging it.
    dragSky(canvas) {
        let from = null;
        canvas.addEventListener("pointerdown", (event) => {
            from = [event.clientX, this.viewer.state.room.turn];
            canvas.setPointerCapture(event.pointerId);
        });
        canvas.addEventListener("pointermove", (event) => {
            if (!from || !canvas.hasPointerCapture(event.pointerId)) return;
            const turn = from[1] + ((event.clientX - from[0]) / canvas.clientWidth) * 360;
            this.viewer.turnRoom(Math.round(((((turn + 180) % 360) + 360) % 360) - 180));
        });
        canvas.addEventListener("pointerup", () => (from = null));
    }

    // What comes from the middle is ahead of the camera; turned, it is further right.
    paintSky(map, turn) {
        if (this.painted && this.painted.map === map && this.painted.turn === turn) return;
        this.painted = { map, turn };
        const canvas = get("sky"), { width, height } = canvas, context = canvas.getContext("2d"), image = context.createImageData(width, height);
        const mean = map.data.reduce((s, x) => s + x, 0) / map.data.length, scale = 0.35 / (mean || 1);
        for (let y = 0; y < height; y++)
            for (let x = 0; x < width; x++) {
                const u = (((x / width - turn / 360) % 1) + 1) % 1, from = 3 * (Math.floor((y / height) * map.height) * map.width + Math.floor(u * map.width));
                for (let c = 0; c < 3; c++) {
                    const v = map.data[from + c] * scale, soft = v / (1 + 0.25 * v);
                    image.data[4 * (y * width + x) + c] = 255 * Math.min(soft <= 0.0031308 ? 12.92 * soft : 1.055 * soft ** (1 / 2.4) - 0.055, 1);
                }
                image.data[4 * (y * width + x) + 3] = 255;
            }
        context.putImageData(image, 0, 0);
    }

    async copy() {
        try {
            await navigator.clipboard.writeText(get("command").textContent);
            this.viewer.say("Copied");
        } catch {
            getSelection().selectAllChildren(get("command"));
            this.viewer.say("Marked: copy it by the keyboard");
        }
    }

    slide(id, value, words) {
        const input = get(id);
        input.value = value;
        input.setAttribute("aria-valuetext", words);
        input.parentElement.querySelector("output").textContent = words;
    }

    show(state) {
        const lamp = state.lamps[state.chosen];
        for (const i of [0, 1]) {
            const button = get(`choose-${i}`);
            button.setAttribute("aria-pressed", String(i === state.chosen));
            button.setAttribute("aria-label", `Lamp ${i + 1}${state.lamps[i].on ? "" : ", off"}`);
            button.classList.toggle("off", !state.lamps[i].on);
            button.style.setProperty("--color", state.lamps[i].color);
        }
        get("lamp-on").checked = lamp.on;
        get("lamp-controls").classList.toggle("off", !lamp.on);
        get("far").checked = lamp.far;
        this.slide("height", lamp.height, lamp.height.toFixed(2));
        this.slide("power", Math.log2(lamp.power), `${twoDigits(lamp.power)}×`);
        for (const [button, color] of this.swatches) button.setAttribute("aria-pressed", String(color === lamp.color));
        this.anyColor.value = lamp.color;
        this.slide("ev", state.ev, signed(state.ev));
        this.showRoom(state);
        const command = commandOf(state, this.viewer.scene, this.viewer.panorama ? this.viewer.panorama.name : "");
        get("command").textContent = command || "merlin relight has no words for this light";
        get("copy").hidden = !command;
    }

    showRoom(state) {
        const { kind, turn, ev } = state.room, { sky, panorama } = this.viewer;
        for (const [other, input] of this.rooms) input.checked = other === kind;
        this.rooms.get("sh").parentElement.hidden = !state.room.sh;
        const file = this.rooms.get("panorama").parentElement;
        file.hidden = !panorama;
        if (panorama) file.lastChild.textContent = panorama.name;
        get("room-controls").hidden = kind === "none" || !sky;
        if (kind === "none" || !sky) return;
        this.slide("room-ev", ev, signed(ev));
        this.slide("room-turn", turn, `${Math.round(turn)}°`);
        this.paintSky(sky.map, turn);
        const area = get("harmonics");
        if (document.activeElement !== area) {
            area.value = writeHarmonics(sky.told || sky.sh);
            area.setAttribute("aria-invalid", "false");
        }
    }
}
