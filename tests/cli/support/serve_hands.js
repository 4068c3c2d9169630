// SPDX-License-Identifier: MIT
// Run in merlin serve's page, into which a photograph was dropped: does with it what people do, and gives back a line for
// each thing that should be so.

const lines = [];
const get = (id) => document.getElementById(id);
const later = () => new Promise((done) => setTimeout(done, 50));
const card = (title) => [...document.querySelectorAll(".card")].find((one) => one.getAttribute("aria-label") === title);
const said = (title) => card(title)?.querySelector(".what p").textContent || "";
const button = (title, words) => [...card(title).querySelectorAll("button")].find((one) => one.textContent.startsWith(words));

// What is so now or, for the network takes its time, within a minute.
async function check(what, so) {
    let now = so();
    for (let i = 0; i < 1200 && !now; i++) {
        await later();
        now = so();
    }
    lines.push(`${now ? "ok" : "FAILED"}: ${what}`);
}

const violations = [];
document.addEventListener("securitypolicyviolation", (e) => violations.push(e.violatedDirective));
// Events that are made have no pointer that could be captured.
Element.prototype.setPointerCapture = () => {};

const key = (element, name, more = {}) => element.dispatchEvent(new KeyboardEvent("keydown", { key: name, bubbles: true, cancelable: true, ...more }));
const canvas = get("mask-picture");
// Whether a place of the picture, in shares of it, is the object: not veiled.
function is_object(x, y) {
    const [red, green] = canvas.getContext("2d").getImageData(x * canvas.width, y * canvas.height, 1, 1).data;
    return red <= green + 20;
}
function point(kind, x, y) {
    const box = canvas.getBoundingClientRect();
    canvas.dispatchEvent(new PointerEvent(kind, { bubbles: true, pointerId: 1, buttons: 1, clientX: box.left + x * box.width, clientY: box.top + y * box.height }));
}
function stroke(x, y, to_x, to_y) {
    point("pointerdown", x, y);
    point("pointermove", to_x, to_y);
    point("pointerup", to_x, to_y);
    point("pointermove", 0.9, 0.97); // the ring around the brush goes elsewhere
}

async function result() {
    await check("a photograph that is dropped becomes a result", () => said("cup.png").startsWith("Done by"));
    await check("the viewer runs in it", () => card("cup.png").querySelector("iframe").contentDocument?.documentElement?.dataset.ready !== undefined);
    await check("its files are listed", () => card("cup.png").querySelector(".files a[download='maps.exr']"));
    await check("the bar is gone", () => card("cup.png").querySelector("progress").hidden);
}

async function lamps() {
    const form = card("cup.png").querySelector("form");
    form.querySelector("select").value = "right";
    form.requestSubmit();
    await check("the server makes a picture in other light", () => card("cup.png").querySelector(".pictures img")?.naturalWidth === 512);
    form.querySelector("select").value = "own";
    form.querySelector("select").dispatchEvent(new Event("change"));
    form.querySelector("input[type=text]").value = "1,2";
    form.requestSubmit();
    await check("a wrong place is told", () => card("cup.png").querySelector("[role=status]").textContent.startsWith("light wants 3 numbers"));
}

async function brush() {
    button("cup.png", "Mask").click();
    await check("the mask is shown", () => get("mask").open && !canvas.hidden && canvas.width === 512);
    await check("the object is not veiled, its surroundings are", () => is_object(0.5, 0.6) && !is_object(0.1, 0.1));
    stroke(0.05, 0.1, 0.2, 0.1);
    await check("the brush adds", () => is_object(0.1, 0.1));
    get("undo").click();
    await check("a stroke is undone", () => !is_object(0.1, 0.1));
    key(canvas, "x");
    await check("X changes the brush", () => document.querySelector("input[name=tool]:checked").value === "remove");
    stroke(0.5, 0.55, 0.5, 0.65);
    await check("the brush removes", () => !is_object(0.5, 0.6));
    key(canvas, "z", { ctrlKey: true });
    await check("Ctrl+Z undoes", () => is_object(0.5, 0.6));
    const before = canvas.clientWidth;
    key(canvas, "+");
    await check("it comes nearer", () => canvas.clientWidth > before);
    key(canvas, "-");
    key(canvas, "x");
    point("pointermove", 0.1, 0.95);
    key(canvas, " ");
    for (let i = 0; i < 10; i++) key(canvas, "ArrowRight");
    key(canvas, " ");
    point("pointermove", 0.9, 0.1);
    await check("keys paint", () => is_object(0.15, 0.95));
    get("mask-again").click();
    await check("Reset is the mask as it was found", () => !is_object(0.15, 0.95));
    stroke(0.05, 0.1, 0.2, 0.1);
    get("mask-done").click();
    await check("the painted mask is used", () => !get("mask").open && said("cup.png").startsWith("Done by") === false);
    await check("a result comes of it", () => said("cup.png").startsWith("Done by"));
    const mask = await createImageBitmap(await (await fetch(card("cup.png").querySelector(".files a[download='mask.png']").href)).blob());
    const seen = new OffscreenCanvas(512, 512).getContext("2d");
    seen.drawImage(mask, 0, 0);
    await check("which has what was painted", () => seen.getImageData(60, 51, 1, 1).data[0] > 128 && seen.getImageData(400, 20, 1, 1).data[0] < 128);
}

async function faults() {
    const files = new DataTransfer();
    files.items.add(new File(["no picture"], "words.png"));
    dispatchEvent(new DragEvent("drop", { dataTransfer: files, bubbles: true, cancelable: true }));
    await check("what is no picture is told", () => said("words.png").includes("words.png") && card("words.png").querySelector(".wrong"));
    button("words.png", "Remove").click();
    await check("it can be removed", () => !card("words.png"));
    get("files").focus();
    document.querySelector("input[name=what][value=stereo]").click();
    dispatchEvent(new DragEvent("drop", { dataTransfer: files, bubbles: true, cancelable: true }));
    await check("one picture is no capture", () => get("trouble").textContent.startsWith("Many lights are two pictures"));
    button("cup.png", "Remove").click();
    await check("a result can be removed, from the server, too", () => !card("cup.png"));
}

async function all() {
    await result();
    await lamps();
    await brush();
    await faults();
    await check("every control has a name", () => [...document.querySelectorAll("button, select, input, canvas, a, iframe")].every((one) =>
        (one.getAttribute("aria-label") || one.title || one.labels?.[0]?.textContent || one.textContent || "").trim()));
    await check(`the page keeps to its policy ${violations}`, () => !violations.length);
    return lines.join("\n");
}
