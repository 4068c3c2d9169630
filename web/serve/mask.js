// SPDX-License-Identifier: MIT
// The mask, corrected by a brush: what is not the object is veiled, and strokes add to it or take from it.
import { byId, say } from "./parts.js";

const dialog = byId("mask"), canvas = byId("mask-picture"), frame = byId("mask-frame"), words = byId("mask-words");
const most_undone = 500;

let photo = null, found = null; // pictures
let drawn = null; // a canvas, opaque on the object
let strokes = [];
let stroke = null; // the one that is being painted
let at = { x: 0, y: 0 }, seen = false, down = false; // the brush: place, whether it is shown, whether keys hold it down
let zoom = 1;
let finish = null;

const tool = () => dialog.querySelector("input[name=tool]:checked").value;
const width_of_brush = () => byId("brush").value * Math.max(canvas.width, canvas.height) / 1000;

function choose(name) {
    dialog.querySelector(`input[name=tool][value=${name}]`).checked = true;
    frame.dataset.tool = name;
}

// ---- painting ----

function paint(context, { remove: takes, width, points }) {
    context.globalCompositeOperation = takes ? "destination-out" : "source-over";
    context.lineWidth = width;
    context.lineCap = context.lineJoin = "round";
    context.strokeStyle = "#fff";
    context.beginPath();
    context.moveTo(points[0].x, points[0].y);
    for (const point of points) context.lineTo(point.x, point.y + 1e-3);
    context.stroke();
}

function start_over() {
    const context = drawn.getContext("2d");
    context.globalCompositeOperation = "source-over";
    context.clearRect(0, 0, drawn.width, drawn.height);
    context.drawImage(found, 0, 0);
}

function show() {
    const context = canvas.getContext("2d"), { width, height } = canvas;
    const shade = new OffscreenCanvas(width, height), dark = shade.getContext("2d");
    dark.fillStyle = "#8c1f5fb0";
    dark.fillRect(0, 0, width, height);
    dark.globalCompositeOperation = "destination-out";
    dark.drawImage(drawn, 0, 0);
    context.drawImage(photo, 0, 0);
    context.drawImage(shade, 0, 0);
    if (!seen || tool() === "move") return;
    for (const [color, grow] of [["#000", 1.5], ["#fff", 0]]) {
        context.beginPath();
        context.arc(at.x, at.y, Math.max(1, width_of_brush() / 2 + grow * canvas.width / canvas.clientWidth), 0, 7);
        context.lineWidth = 1.5 * canvas.width / canvas.clientWidth;
        context.strokeStyle = color;
        context.stroke();
    }
}

function begin_stroke() {
    stroke = { remove: tool() === "remove", width: width_of_brush(), points: [{ ...at }] };
    paint(drawn.getContext("2d"), stroke);
    show();
}

function go_on() {
    stroke.points.push({ ...at });
    paint(drawn.getContext("2d"), { ...stroke, points: stroke.points.slice(-2) });
    show();
}

function end_stroke() {
    if (stroke) strokes.push(stroke);
    if (strokes.length > most_undone) strokes.shift();
    stroke = null;
    down = false;
    byId("undo").disabled = !strokes.length;
}

function repaint() {
    start_over();
    for (const one of strokes) paint(drawn.getContext("2d"), one);
    byId("undo").disabled = !strokes.length;
    show();
}

function undo() {
    end_stroke();
    if (!strokes.pop()) return;
    repaint();
    say("The last stroke is undone");
}

// ---- hands ----

function place(e) {
    const box = canvas.getBoundingClientRect();
    at = { x: (e.clientX - box.left) * canvas.width / box.width, y: (e.clientY - box.top) * canvas.height / box.height };
    seen = true;
}

canvas.addEventListener("pointerdown", (e) => {
    if (e.button > 0 || !drawn) return;
    canvas.setPointerCapture(e.pointerId);
    place(e);
    if (tool() === "move") return;
    e.preventDefault();
    canvas.focus({ preventScroll: true });
    if (!stroke) begin_stroke();
});
canvas.addEventListener("pointermove", (e) => {
    if (!drawn) return;
    if (tool() === "move") {
        if (e.buttons & 1) frame.scrollBy(-e.movementX, -e.movementY);
        return;
    }
    for (const one of e.getCoalescedEvents?.().length ? e.getCoalescedEvents() : [e]) {
        place(one);
        if (stroke && !down) go_on();
    }
    show();
});
for (const kind of ["pointerup", "pointercancel"]) canvas.addEventListener(kind, () => { if (!down) end_stroke(); });
canvas.addEventListener("pointerleave", () => {
    if (down) return;
    seen = false;
    if (drawn) show();
});
canvas.addEventListener("focus", () => {
    if (!drawn || !canvas.matches(":focus-visible")) return;
    seen = true;
    show();
});

const steps = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
canvas.addEventListener("keydown", (e) => {
    if (!drawn) return;
    if (steps[e.key]) {
        const far = Math.max(canvas.width, canvas.height) / (e.shiftKey ? 20 : 100);
        at.x = Math.min(Math.max(at.x + steps[e.key][0] * far, 0), canvas.width);
        at.y = Math.min(Math.max(at.y + steps[e.key][1] * far, 0), canvas.height);
        seen = true;
        if (down) go_on();
        else show();
    } else if (e.key === " " || e.key === "Enter") {
        if (tool() === "move") return;
        if (down) end_stroke();
        else if (!stroke) {
            begin_stroke();
            down = true;
        }
        say(down ? (stroke.remove ? "Removing" : "Adding") : "The brush is up");
    } else return;
    e.preventDefault();
});
dialog.addEventListener("keydown", (e) => {
    if (!drawn) return;
    if (e.key === "z" && (e.ctrlKey || e.metaKey)) undo();
    else if (e.ctrlKey || e.metaKey || e.altKey) return;
    else if (e.key === "[" || e.key === "]") byId("brush")[e.key === "[" ? "stepDown" : "stepUp"](10);
    else if (e.key === "x") choose(tool() === "add" ? "remove" : "add");
    else if (e.key === "+" || e.key === "-") scale(e.key === "+" ? 1.5 : 1 / 1.5);
    else return;
    e.preventDefault();
    show();
});
dialog.addEventListener("change", () => {
    frame.dataset.tool = tool();
    if (drawn) show();
});
byId("undo").addEventListener("click", undo);
byId("mask-again").addEventListener("click", () => {
    strokes = [];
    repaint();
    say("The mask is as it was found");
});

function scale(by) {
    zoom = by ? Math.min(Math.max(zoom * by, 1), 8) : 1;
    const fit = Math.min(frame.clientWidth / canvas.width, frame.clientHeight / canvas.height);
    canvas.style.width = `${Math.floor(canvas.width * fit * zoom)}px`;
    if (drawn) show();
}
byId("nearer").addEventListener("click", () => scale(1.5));
byId("farther").addEventListener("click", () => scale(1 / 1.5));
addEventListener("resize", () => { if (dialog.open && drawn) scale(0); });

// ---- the whole ----

// White on the object and black beside it, made opaque on it and clear beside it.
async function opacity(mask) {
    const clear = new OffscreenCanvas(mask.width, mask.height), context = clear.getContext("2d");
    context.drawImage(mask, 0, 0);
    const pixels = context.getImageData(0, 0, mask.width, mask.height);
    for (let i = 0; i < pixels.data.length; i += 4) pixels.data[i + 3] = pixels.data[i] > 127 ? 255 : 0;
    context.putImageData(pixels, 0, 0);
    return clear;
}

// The mask as a PNG of two values; null: nothing of it is left.
async function as_file() {
    const pixels = drawn.getContext("2d").getImageData(0, 0, drawn.width, drawn.height);
    let object = 0;
    for (let i = 0; i < pixels.data.length; i += 4) {
        const is = pixels.data[i + 3] > 127;
        object += is;
        pixels.data.fill(is ? 255 : 0, i, i + 3);
        pixels.data[i + 3] = 255;
    }
    if (!object) return null;
    const out = new OffscreenCanvas(drawn.width, drawn.height);
    out.getContext("2d").putImageData(pixels, 0, 0);
    return new File([await out.convertToBlob({ type: "image/png" })], "mask.png", { type: "image/png" });
}

function ready(is) {
    for (const id of ["mask-done", "mask-again", "nearer", "farther"]) byId(id).disabled = !is;
    byId("undo").disabled = true;
    canvas.hidden = !is;
    words.hidden = is;
}

async function load(file, mask, find) {
    const seen_in = await find(file, (told) => { words.textContent = told; });
    photo = seen_in.photo;
    found = await opacity(mask ? await createImageBitmap(mask) : seen_in.mask);
}

// Lets a person correct the mask of a photograph; mask: the one that was painted before, or null. find(file, told) gives
// the photograph and the mask that is found in it, pictures of the same size, and tells what it waits for. Gives a file,
// or null.
export function correct(file, mask, find) {
    photo = found = drawn = stroke = null;
    strokes = [];
    seen = down = false;
    zoom = 1;
    byId("mask-title").textContent = `The object of ${file.name}`;
    words.textContent = "Finding the object";
    ready(false);
    choose("add");
    dialog.showModal();
    const opened = {};
    const given = new Promise((done) => { finish = opened.finish = done; });
    load(file, mask, find).then(() => {
        if (finish !== opened.finish || !dialog.open) return;
        canvas.width = photo.width;
        canvas.height = photo.height;
        drawn = new OffscreenCanvas(photo.width, photo.height);
        at = { x: canvas.width / 2, y: canvas.height / 2 };
        start_over();
        ready(true);
        scale(0);
        canvas.focus();
    }, (error) => { words.textContent = error.message; });
    return given;
}

byId("mask-done").addEventListener("click", async () => {
    end_stroke();
    const file = await as_file();
    if (!file) {
        say("Nothing is left of the object");
        words.textContent = "Nothing is left of the object: add to it.";
        words.hidden = false;
        return;
    }
    finish?.(file);
    finish = null;
    dialog.close();
});
byId("mask-cancel").addEventListener("click", () => dialog.close());
dialog.addEventListener("close", () => {
    finish?.(null);
    finish = drawn = null;
});
