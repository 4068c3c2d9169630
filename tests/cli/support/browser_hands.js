// SPDX-License-Identifier: MIT
// Run in the page of web/browser: does with it what people do.

const get = (id) => document.getElementById(id);
const later = () => new Promise((done) => setTimeout(done, 50));

// Waits until something is so, for three minutes at most.
async function until(so) {
    for (let i = 0; i < 3600 && !so(); i++) await later();
    return so();
}

const trouble = () => (get("trouble").hidden ? "" : get("trouble").textContent);

// A photograph that was dropped is taken, or there is trouble.
async function taken() {
    await later();
    await until(() => !get("files").disabled);
    return trouble();
}

// Presses Estimate, and gives what the page says of the result.
async function estimated() {
    get("estimate").click();
    await until(() => !get("result").hidden || trouble());
    return trouble() || get("result").firstChild.textContent;
}

// A file of the result, in base64.
async function file(name) {
    const bytes = new Uint8Array(await (await fetch(document.querySelector(`.files a[download="${name}"]`).href)).arrayBuffer());
    let text = "";
    for (const byte of bytes) text += String.fromCharCode(byte);
    return btoa(text);
}
