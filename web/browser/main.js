// SPDX-License-Identifier: MIT
// The page: a photograph, its mask, the estimate, and what came of it. Everything happens in this browser.
import { zipSync } from "./fflate.js";
import { Estimator } from "./estimator.js";
import { correct } from "./mask.js";
import { byId, bytes, make, say, take_drops } from "./parts.js";

const MAPS = [["albedo.png", "Albedo"], ["normal.png", "Normals"], ["roughness.png", "Roughness"], ["depth.png", "Depth"], ["reconstruction.png", "Reconstruction"], ["mask.png", "Mask"]];
const TYPES = { png: "image/png", html: "text/html", json: "application/json", exr: "image/x-exr" };
const DIAGONAL = Math.hypot(36, 24); // mm, of the frame for which EXIF tells the focal length
const VIEWS = 4;

const estimator = new Estimator();
let shot = null; // the photograph: {file, found, painted, masked}
let addresses = [];

function complain(words) {
    byId("trouble").textContent = words;
    byId("trouble").hidden = !words;
}

// ---- photograph and mask ----

// A veil over what is not the object, as the mask's editor has it.
function veil_of(mask, width, height) {
    const context = new OffscreenCanvas(width, height).getContext("2d");
    context.drawImage(mask, 0, 0);
    const pixels = context.getImageData(0, 0, width, height);
    for (let i = 0; i < pixels.data.length; i += 4) pixels.data.set([140, 31, 95, 0.69 * (255 - pixels.data[i])], i);
    context.putImageData(pixels, 0, 0);
    return context.canvas;
}

async function show_picture() {
    const { photo, mask } = shot.found, canvas = byId("picture"), context = canvas.getContext("2d");
    Object.assign(canvas, { width: photo.width, height: photo.height });
    context.drawImage(photo, 0, 0);
    const seen = shot.painted ? await createImageBitmap(shot.painted) : mask;
    if (seen) context.drawImage(veil_of(seen, photo.width, photo.height), 0, 0);
    shot.masked = Boolean(seen);
    byId("estimate").disabled = !seen;
}

function words_of_object({ trouble, confidence, reduced, photo }) {
    const size = reduced ? ` The photograph was reduced to ${photo.width} × ${photo.height} pixels.` : "";
    if (shot.painted) return `The mask is yours.${size}`;
    if (trouble) return `${trouble.replace(/[;.].*/s, "")}. Paint the object by “Mask…”.${size}`; // the rest is about the command
    return `${confidence < 0.5 ? "The object was found, but not surely: check its mask." : "The object was found."}${size}`;
}

function words_of_lens({ focal, photo }) {
    if (!focal) return "The photograph does not tell its lens. If you know it, type its horizontal angle.";
    const degrees = (2 * Math.atan((photo.width * DIAGONAL) / (2 * focal * Math.hypot(photo.width, photo.height))) * 180) / Math.PI;
    byId("fov").placeholder = degrees.toFixed(1);
    return `By its EXIF: ${degrees.toFixed(1)} degrees horizontally.`;
}

async function take(file) {
    complain("");
    clear();
    busy(true, "Finding the object");
    byId("work").hidden = false;
    byId("name").textContent = file.name;
    try {
        const found = await estimator.call("take", [file]);
        shot = { file, found, painted: null };
        byId("fov").value = "";
        byId("fov").placeholder = "unknown";
        byId("fov-hint").textContent = words_of_lens(found);
        byId("object").textContent = words_of_object(found);
        await show_picture();
        byId("work").hidden = false;
    } catch (error) {
        shot = null;
        byId("work").hidden = true;
        complain(error.message);
    }
    busy(false, "");
}

async function repaint() {
    const none = new OffscreenCanvas(shot.found.photo.width, shot.found.photo.height);
    none.getContext("2d");
    const painted = await correct(shot.file, shot.painted, async () => ({ photo: shot.found.photo, mask: shot.found.mask || none }));
    byId("correct").focus();
    if (!painted) return;
    try {
        await estimator.call("set_mask", [painted]);
        shot.painted = painted;
        byId("object").textContent = words_of_object(shot.found);
        await show_picture();
    } catch (error) {
        complain(error.message);
    }
}

// ---- the estimate ----

function busy(is, words) {
    byId("bar").hidden = !is;
    byId("bar").removeAttribute("value");
    byId("stage").textContent = words;
    for (const id of ["correct", "files"]) byId(id).disabled = is;
    byId("estimate").disabled = is || !shot?.masked;
}

function clear() {
    for (const address of addresses) URL.revokeObjectURL(address);
    addresses = [];
    byId("result").hidden = true;
    byId("result").replaceChildren();
}

// Which share of an estimate is done: runs of the large picture take four times as long.
function progress_of(size) {
    const whole = 1 + VIEWS + (size > 256 ? 2 * (size / 256) ** 2 : 0);
    return ({ stage, run, share }) => {
        byId("stage").textContent = stage + (stage === "Estimating" && run > 1 ? "" : "…");
        if (stage === "Estimating") byId("bar").value = Math.min(run <= 1 + VIEWS ? run - 1 : 1 + VIEWS + (run - 2 - VIEWS) * (size / 256) ** 2, whole) / whole;
        else if (share !== undefined) byId("bar").value = share;
    };
}

async function estimate() {
    const size = Number(document.querySelector("input[name=detail]:checked").value), fov = byId("fov").value;
    complain("");
    if (fov && !(fov >= 1 && fov <= 150)) {
        byId("fov").focus();
        return complain("A field of view is 1 to 150 degrees.");
    }
    clear();
    busy(true, "Estimating…");
    byId("cancel").hidden = false;
    byId("cancel").focus();
    try {
        const how = { fov: Number(fov) || 0, flash: byId("flash").checked, size, views: VIEWS, name: shot.file.name.replace(/\.[^.]*$/, "") };
        const result = await estimator.call("estimate", [how], progress_of(size));
        busy(false, result ? "" : "Cancelled");
        if (result) show_result(how.name, result.files, result.seconds);
        say(`${shot.file.name} is ${result ? "done" : "cancelled"}`);
    } catch (error) {
        busy(false, "");
        complain(error.message);
    }
    byId("cancel").hidden = true;
    byId("estimate").focus({ preventScroll: true });
}

// ---- what came of it ----

function address_of(name, data) {
    const address = URL.createObjectURL(new Blob([data], { type: TYPES[name.split(".").pop()] || "application/zip" }));
    addresses.push(address);
    return address;
}

function show_result(title, files, seconds) {
    const report = JSON.parse(new TextDecoder().decode(files.get("report.json"))), at = new Map();
    for (const [name, data] of files) at.set(name, address_of(name, data));
    const zip = address_of("zip", zipSync(Object.fromEntries(files), { level: 0 })), view = at.get("viewer.html");
    byId("result").append(
        make("p", { class: "dim" }, `Done by ${report.model}, ${seconds < 10 ? seconds.toFixed(1) : Math.round(seconds)} s`),
        ...report.warnings.map((warning) => make("p", { class: "warning" }, warning.message)),
        make("iframe", { src: view, title: `Viewer of ${title}`, allow: "fullscreen" }),
        make("p", {}, make("a", { href: view, target: "_blank" }, "Open the viewer in a tab of its own"), " · ",
            make("a", { href: view, download: `${title}.html` }, "Save the viewer, one file")),
        make("div", { class: "maps" }, ...MAPS.map(([name, words]) => make("a", { href: at.get(name), download: name }, make("img", { src: at.get(name), alt: "" }), words))),
        make("p", {}, make("a", { href: zip, download: `${title}.merlin.zip` }, "All files, as a ZIP archive")),
        make("details", {}, make("summary", {}, `Files (${files.size})`), make("ul", { class: "files" }, ...[...files].map(([name, data]) =>
            make("li", {}, make("a", { href: at.get(name), download: name }, name), " ", make("span", { class: "dim" }, bytes(data.length)))))));
    byId("result").hidden = false;
}

// ---- hands ----

byId("files").addEventListener("change", (e) => {
    const [file] = e.target.files;
    e.target.value = "";
    if (file) take(file);
});
byId("correct").addEventListener("click", repaint);
byId("estimate").addEventListener("click", estimate);
byId("cancel").addEventListener("click", () => estimator.call("cancel"));

take_drops(([file]) => { if (file && !byId("mask").open && !byId("files").disabled) take(file); });

async function start() {
    byId("files").disabled = true;
    try {
        if (typeof WebAssembly !== "object") throw new Error("This browser has no WebAssembly, by which this page computes: use another, or allow it.");
        if (typeof OffscreenCanvas === "undefined") throw new Error("This browser is too old for this page: it knows no OffscreenCanvas.");
        byId("version").textContent = `merlin ${(await estimator.call("start")).version}`;
        byId("files").disabled = false;
    } catch (error) {
        complain(error.message);
    }
    document.documentElement.dataset.ready = "";
}
start();
