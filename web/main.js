// SPDX-License-Identifier: MIT
// Starts the viewer, or says what is in its way.
import { Scene } from "./scene.js";
import { Viewer } from "./viewer.js";

const get = (id) => document.getElementById(id);

async function start() {
    let scene = null;
    try {
        scene = await Scene.read();
        const viewer = new Viewer(scene, get("canvas"));
        await viewer.start();
        document.documentElement.dataset.ready = "";
    } catch (error) {
        console.error(error);
        document.documentElement.classList.add("broken");
        get("trouble").hidden = false;
        get("trouble").textContent = error.message;
        if (scene && scene.photoFile) showPhotograph(scene.photoFile);
    }
}

// Where nothing can be lit.
function showPhotograph(file) {
    const image = Object.assign(document.createElement("img"), { src: URL.createObjectURL(file), alt: "The photograph of the object" });
    get("stage").prepend(image);
}

start();
