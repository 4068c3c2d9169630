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

// A picture of one colour as a PNG, in base64.
async function blank(width, height) {
    const context = new OffscreenCanvas(width, height).getContext("2d");
    context.fillStyle = "#777";
    context.fillRect(0, 0, width, height);
    const bytes = new Uint8Array(await (await context.canvas.convertToBlob()).arrayBuffer());
    return btoa(Array.from(bytes, (byte) => String.fromCharCode(byte)).join(""));
}

// Begins an estimate and cancels it; gives what the page says.
async function cancelled() {
    get("estimate").click();
    get("cancel").click();
    await until(() => get("bar").hidden);
    return trouble() || get("stage").textContent;
}

const choose = (id, is) => { if (get(id).checked !== is) get(id).click(); };

// A photograph as the page takes it, in base64: a picture of this result on grey, turned by its orientation as a JPEG.
async function jpeg_of(name, width, height) {
    const context = new OffscreenCanvas(width, height).getContext("2d");
    context.fillStyle = "#6b6b66";
    context.fillRect(0, 0, width, height);
    context.drawImage(await createImageBitmap(await (await fetch(document.querySelector(`.files a[download="${name}"]`).href)).blob()), 60, 40, 400, 400);
    const bytes = new Uint8Array(await (await context.canvas.convertToBlob({ type: "image/jpeg", quality: 0.95 })).arrayBuffer());
    return btoa(Array.from(bytes, (byte) => String.fromCharCode(byte)).join(""));
}

// Opens the mask's editor and paints a line, from one place to another in shares of the picture.
async function painted(tool, from, to) {
    const canvas = get("mask-picture"), point = (kind, [x, y]) => {
        const box = canvas.getBoundingClientRect();
        canvas.dispatchEvent(new PointerEvent(kind, { bubbles: true, pointerId: 1, buttons: 1, clientX: box.left + x * box.width, clientY: box.top + y * box.height }));
    };
    Element.prototype.setPointerCapture = () => {}; // made events have no pointer that could be captured
    get("correct").click();
    await until(() => get("mask").open && !canvas.hidden);
    document.querySelector(`input[name=tool][value=${tool}]`).click();
    point("pointerdown", from);
    point("pointermove", to);
    point("pointerup", to);
    get("mask-done").click();
    await until(() => !get("mask").open && !get("object").textContent.startsWith("The object"));
    return get("object").textContent;
}

const nameless = () => [...document.querySelectorAll("button, select, input, canvas, a, iframe, progress")].filter((one) =>
    !(one.getAttribute("aria-label") || one.title || one.labels?.[0]?.textContent || one.textContent || "").trim()).map((one) => one.id || one.tagName).join(" ");

// Whether this server can be reached as another host, which localhost is to a page of 127.0.0.1.
const other_host = (by) => by(`http://localhost:${location.port}/index.html`, { mode: "no-cors" }).then(() => "reached", () => "refused");

// fetch in a worker that is started as the page starts its own.
const in_worker = (address, how) => new Promise((done, failed) => {
    const program = `fetch(${JSON.stringify(address)}, ${JSON.stringify(how)}).then(() => postMessage("reached"), () => postMessage("refused"));`;
    const worker = new Worker(URL.createObjectURL(new Blob([program], { type: "text/javascript" })), { type: "module" });
    worker.onmessage = ({ data }) => (data === "reached" ? done() : failed());
});
