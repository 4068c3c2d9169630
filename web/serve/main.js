// SPDX-License-Identifier: MIT
import { status } from "./api.js";
import { Card } from "./card.js";
import { byId, bytes } from "./parts.js";

let limits = { bytes: Infinity };

function complain(words) {
    byId("trouble").textContent = words;
    byId("trouble").hidden = !words;
}

async function estimate(file) {
    if (file.size > limits.bytes) return complain(`${file.name} has ${bytes(file.size)}: this server takes ${bytes(limits.bytes)} at most.`);
    byId("none").hidden = true;
    await new Card(byId("jobs"), file.name, URL.createObjectURL(file)).run("estimate", [["photo", file]]);
}

function take(files) {
    complain("");
    for (const file of files) estimate(file);
}

byId("files").addEventListener("change", (e) => {
    take([...e.target.files]);
    e.target.value = "";
});
for (const kind of ["dragenter", "dragover"])
    addEventListener(kind, (e) => {
        if (!e.dataTransfer?.types.includes("Files")) return;
        e.preventDefault();
        byId("drop").classList.add("over");
    });
for (const kind of ["dragleave", "drop"])
    addEventListener(kind, (e) => {
        if (kind === "dragleave" && e.relatedTarget) return;
        e.preventDefault();
        byId("drop").classList.remove("over");
        if (kind === "drop") take([...e.dataTransfer.files]);
    });

status().then((told) => {
    limits = told.limits;
    byId("version").textContent = `merlin ${told.version}, ${told.model}`;
    byId("keep").textContent = `${Math.round(told.keep_seconds / 60)} minutes after they are done`;
}, (error) => complain(error.message)).finally(() => {
    document.documentElement.dataset.ready = "";
});
