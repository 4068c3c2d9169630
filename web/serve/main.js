// SPDX-License-Identifier: MIT
import { status } from "./api.js";
import { Card } from "./card.js";
import { byId, bytes, take_drops } from "./parts.js";

let limits = { bytes: Infinity, files: Infinity };
const hints = {
    estimate: ["Drop photographs here, or choose them", "Best by the camera’s own flash, the object in the middle"],
    stereo: ["Drop all pictures of the object here, or choose them", "One camera, one light at a time, such as a lamp moved by hand; with lights.txt or an .lp file, if the lights are known, and mask.png"],
};

const what = () => document.querySelector("input[name=what]:checked").value;

function complain(words) {
    byId("trouble").textContent = words;
    byId("trouble").hidden = !words;
}

// A capture's files by their names: its lights, its mask, the picture without any of the lights, and all others.
function part_of(file) {
    const name = file.name.toLowerCase();
    if (/\.(lp|txt)$/.test(name)) return "lights";
    if (/^mask\.|[._-]mask\.[a-z]+$/.test(name)) return "mask";
    return /^ambient\./.test(name) ? "ambient" : "pictures";
}

function add(title, kind, files) {
    const size = files.reduce((sum, [, file]) => sum + file.size, 0);
    if (size > limits.bytes) return complain(`${title} has ${bytes(size)}: this server takes ${bytes(limits.bytes)} at most.`);
    if (files.length > limits.files) return complain(`${title} has ${files.length} files: this server takes ${limits.files} at most.`);
    byId("none").hidden = true;
    new Card(byId("jobs"), title, kind, files, kind === "estimate" ? [["mesh", "1"]] : []);
}

function take(files) {
    complain("");
    if (!files.length) return;
    if (what() === "estimate") for (const file of files) add(file.name, "estimate", [["photo", file]]);
    else if (files.length < 2) complain("Many lights are two pictures or more, all chosen at once.");
    else add(`${files.length} files of one object`, "stereo", files.map((file) => [part_of(file), file]));
}

byId("files").addEventListener("change", (e) => {
    take([...e.target.files]);
    e.target.value = "";
});
for (const radio of document.querySelectorAll("input[name=what]"))
    radio.addEventListener("change", () => { [byId("drop-words").textContent, byId("hint").textContent] = hints[what()]; });

take_drops((files) => { if (!byId("mask").open) take(files); });

status().then((told) => {
    limits = told.limits;
    byId("version").textContent = `merlin ${told.version}`;
    byId("keep").textContent = `${Math.round(told.keep_seconds / 60)} minutes after it is done`;
}, (error) => complain(error.message)).finally(() => {
    document.documentElement.dataset.ready = "";
});
