// SPDX-License-Identifier: MIT
// What pointers, wheel and keys do on the picture. `viewer` does the work (viewer.js).

const CLICK = 5; // screen pixels that a click may move
const STEP = 0.03, FURTHER = 5, TURN_STEP = 5, PAN_STEP = 60, ZOOM_STEP = 1.25;
const ARROWS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };

export class Hands {
    constructor(viewer, canvas) {
        this.viewer = viewer;
        this.canvas = canvas;
        this.down = new Map(); // pointers that press, by id
        this.travelled = 0;
        const on = (name, does, options) => canvas.addEventListener(name, (event) => does.call(this, event), options);
        on("pointerdown", this.press);
        on("pointermove", this.move);
        on("pointerup", this.release);
        on("pointercancel", this.cancel);
        on("pointerleave", () => viewer.tell(null));
        on("wheel", this.wheel, { passive: false });
        on("dblclick", this.twice);
        on("keydown", this.key);
        on("contextmenu", (event) => event.preventDefault());
    }

    at(event) {
        const box = this.canvas.getBoundingClientRect(), ratio = this.viewer.view.ratio;
        return [(event.clientX - box.left) * ratio, (event.clientY - box.top) * ratio];
    }

    press(event) {
        this.viewer.wake();
        this.down.set(event.pointerId, this.at(event));
        this.canvas.setPointerCapture(event.pointerId);
        if (this.down.size === 1) this.travelled = 0;
        else this.travelled = Infinity; // two fingers are no click
        if (event.pointerType !== "mouse" && this.down.size === 1 && !this.viewer.state.solid) this.light(event);
    }

    // Whether a single pointer that presses drags the picture, not the lamp.
    drags(event) {
        const viewer = this.viewer;
        if (event.buttons & ~1) return true;
        return Boolean(viewer.state.solid) || !viewer.isLit() || (event.pointerType === "mouse" && !viewer.view.fitted);
    }

    move(event) {
        const now = this.at(event), before = this.down.get(event.pointerId), viewer = this.viewer;
        viewer.tell(now);
        if (!before) {
            if (event.pointerType === "touch" || viewer.state.held || !viewer.isLit()) return;
            viewer.wake();
            this.light(event);
            return;
        }
        if (this.down.size === 2) return this.pinch(event.pointerId, before, now);
        this.travelled += Math.hypot(now[0] - before[0], now[1] - before[1]);
        this.down.set(event.pointerId, now);
        if (this.travelled < CLICK * viewer.view.ratio) return;
        if (!this.drags(event)) return this.light(event);
        this.canvas.classList.add("moving");
        const dx = now[0] - before[0], dy = now[1] - before[1];
        if (viewer.state.solid && !(event.buttons & ~1) && !event.shiftKey) viewer.turnBy(0.25 * dx / viewer.view.ratio, 0.25 * dy / viewer.view.ratio);
        else viewer.pan(dx, dy);
    }

    // Two fingers: the places under them stay under them.
    pinch(id, before, now) {
        const other = [...this.down].find(([key]) => key !== id)[1], middle = (p) => [(p[0] + other[0]) / 2, (p[1] + other[1]) / 2];
        const apart = (p) => Math.hypot(p[0] - other[0], p[1] - other[1]) || 1, [was, is] = [middle(before), middle(now)];
        this.down.set(id, now);
        this.viewer.pan(is[0] - was[0], is[1] - was[1]);
        this.viewer.zoom(apart(now) / apart(before), ...is);
    }

    release(event) {
        const clicked = this.down.has(event.pointerId) && this.travelled < CLICK * this.viewer.view.ratio;
        this.cancel(event);
        if (clicked && event.pointerType === "mouse" && event.button === 0 && this.viewer.isLit()) this.viewer.hold();
    }

    cancel(event) {
        this.down.delete(event.pointerId);
        this.canvas.classList.remove("moving");
    }

    light(event) {
        this.viewer.lightAt(this.viewer.state.chosen, this.at(event));
    }

    wheel(event) {
        event.preventDefault();
        this.viewer.wake();
        const step = event.deltaMode === 1 ? event.deltaY * 20 : event.deltaY;
        this.viewer.zoom(Math.exp(-step * (event.ctrlKey ? 0.01 : 0.0016)), ...this.at(event));
    }

    twice(event) {
        const view = this.viewer.view;
        if (this.viewer.state.solid) this.viewer.turnTo({ yaw: 0, pitch: 0 });
        this.viewer.zoom(view.fitted ? Math.max(view.ratio / view.scale, 2) : 0, ...this.at(event));
    }

    // ---- keys ----

    key(event) {
        if (event.ctrlKey || event.metaKey || event.altKey) return;
        this.viewer.wake();
        const arrow = ARROWS[event.key];
        if (arrow ? this.arrow(arrow, event.shiftKey ? FURTHER : 1) : this.command(event.key)) event.preventDefault();
    }

    arrow([right, down], times) {
        const viewer = this.viewer;
        if (viewer.state.solid) viewer.turnBy(TURN_STEP * right * times, TURN_STEP * down * times);
        else if (!viewer.view.fitted) viewer.pan(-PAN_STEP * right * times, -PAN_STEP * down * times);
        else if (viewer.isLit()) viewer.nudge(viewer.state.chosen, STEP * right * times, -STEP * down * times);
        else return false;
        return true;
    }

    command(key) {
        const viewer = this.viewer, chosen = viewer.state.chosen;
        const commands = {
            "+": () => viewer.zoom(ZOOM_STEP), "=": () => viewer.zoom(ZOOM_STEP), "-": () => viewer.zoom(1 / ZOOM_STEP),
            0: () => viewer.zoom(0), 1: () => viewer.zoomToPixels(), " ": () => viewer.hold(),
            PageUp: () => viewer.raise(chosen, 0.05), PageDown: () => viewer.raise(chosen, -0.05),
            c: () => viewer.compare(), t: () => viewer.turnAbout(), s: () => viewer.save(), l: () => viewer.switchLamp(1),
            m: () => viewer.showNext(1), "?": () => viewer.help(),
        };
        const does = commands[key.length === 1 ? key.toLowerCase() : key];
        if (does) does();
        return Boolean(does);
    }
}

// The glowing dot of a lamp.
export class LampHandle {
    constructor(viewer, i, element) {
        element.addEventListener("pointerdown", (event) => {
            if (event.button !== 0) return;
            viewer.wake();
            viewer.choose(i);
            element.setPointerCapture(event.pointerId);
        });
        element.addEventListener("pointermove", (event) => {
            if (element.hasPointerCapture(event.pointerId)) viewer.lightAt(i, viewer.hands.at(event));
            else if (!viewer.state.held && i === viewer.state.chosen && event.pointerType !== "touch") viewer.lightAt(i, viewer.hands.at(event));
        });
        element.addEventListener("click", (event) => {
            if (event.detail === 0) viewer.hold(); // by a key
        });
        element.addEventListener("focus", () => viewer.choose(i));
        element.addEventListener("wheel", (event) => viewer.hands.wheel(event), { passive: false });
        element.addEventListener("keydown", (event) => this.key(event, viewer, i));
        let from = null;
        element.addEventListener("pointerdown", (event) => (from = viewer.hands.at(event)));
        element.addEventListener("pointerup", (event) => {
            const to = viewer.hands.at(event);
            if (from && event.pointerType === "mouse" && Math.hypot(to[0] - from[0], to[1] - from[1]) < CLICK * viewer.view.ratio) viewer.hold();
            from = null;
        });
    }

    key(event, viewer, i) {
        if (event.ctrlKey || event.metaKey || event.altKey) return;
        const times = event.shiftKey ? FURTHER : 1, arrow = ARROWS[event.key];
        if (arrow) viewer.nudge(i, STEP * arrow[0] * times, -STEP * arrow[1] * times);
        else if (event.key === "PageUp" || event.key === "PageDown") viewer.raise(i, event.key === "PageUp" ? 0.05 : -0.05);
        else if (event.key === "+" || event.key === "=" || event.key === "-") viewer.strengthen(i, event.key === "-" ? 1 / 1.25 : 1.25);
        else return;
        viewer.wake();
        event.preventDefault();
    }
}

// The line between the photograph and the picture; share: where it is, 0 to 1.
export function handleDivider(viewer, element) {
    const put = (share) => viewer.divide(Math.min(Math.max(share, 0), 1));
    element.addEventListener("pointerdown", (event) => element.setPointerCapture(event.pointerId));
    element.addEventListener("pointermove", (event) => {
        if (element.hasPointerCapture(event.pointerId)) put(viewer.hands.at(event)[0] / viewer.view.width);
    });
    element.addEventListener("keydown", (event) => {
        const now = viewer.state.compare, step = event.shiftKey ? 0.1 : 0.02;
        const to = { ArrowLeft: now - step, ArrowDown: now - step, ArrowRight: now + step, ArrowUp: now + step, Home: 0, End: 1,
            PageUp: now + 0.1, PageDown: now - 0.1 }[event.key];
        if (to === undefined) return;
        put(to);
        event.preventDefault();
    });
}
