// SPDX-License-Identifier: MIT
// Run in a page of merlin view: does with it what people do, and gives back a line for each thing that should be so.

const lines = [];
const get = (id) => document.getElementById(id);
const later = () => new Promise((done) => setTimeout(done, 50));

// What is so now or, for frames take their time where there is no graphics card, within 10 seconds.
async function check(what, so) {
    let now = so();
    for (let i = 0; i < 200 && !now; i++) {
        await later();
        now = so();
    }
    lines.push(`${now ? "ok" : "FAILED"}: ${what}`);
}

// Events that are made have no pointer that could be captured.
Element.prototype.setPointerCapture = () => {};
Element.prototype.hasPointerCapture = () => true;

function point(element, kind, x, y, more = {}) {
    const box = get("stage").getBoundingClientRect();
    element.dispatchEvent(new PointerEvent(kind, {
        bubbles: true, pointerId: 1, pointerType: "mouse", clientX: box.left + x * box.width, clientY: box.top + y * box.height, ...more,
    }));
}

const key = (element, name) => element.dispatchEvent(new KeyboardEvent("keydown", { key: name, bubbles: true }));
const leftOf = (id) => parseFloat(get(id).style.left) / get("stage").clientWidth;

async function lamps() {
    const canvas = get("canvas"), first = get("lamp-0");
    point(canvas, "pointermove", 0.4, 0.4);
    await check("the lamp follows the pointer", () => Math.abs(leftOf("lamp-0") - 0.4) < 0.01);
    point(canvas, "pointerdown", 0.4, 0.4, { buttons: 1 });
    point(canvas, "pointerup", 0.4, 0.4);
    point(canvas, "pointermove", 0.6, 0.6);
    await check("a click holds the lamp", () => Math.abs(leftOf("lamp-0") - 0.4) < 0.01 && first.classList.contains("held"));
    key(first, "ArrowRight");
    await check("an arrow key moves the lamp", () => leftOf("lamp-0") > 0.405);
    const height = Number(get("height").value);
    key(first, "PageUp");
    await check("a key raises the lamp", () => Number(get("height").value) > height);
    await check("the lamp says where it is", () => /from the upper left, height/.test(first.getAttribute("aria-label")));
    key(canvas, "l");
    await check("a key switches the second lamp on", () => !get("lamp-1").hidden);
    point(get("lamp-1"), "pointerdown", 0.6, 0.6, { buttons: 1, button: 0 });
    point(get("lamp-1"), "pointermove", 0.3, 0.7, { buttons: 1 });
    await check("a lamp's dot can be dragged", () => Math.abs(leftOf("lamp-1") - 0.3) < 0.01);
    key(canvas, "l");
}

async function views() {
    const canvas = get("canvas");
    key(canvas, "c");
    await check("a key shows the divider", () => !get("divider").hidden && get("divider").getAttribute("aria-valuenow") === "50");
    key(get("divider"), "ArrowRight");
    await check("a key moves the divider", () => get("divider").getAttribute("aria-valuenow") === "52");
    key(canvas, "t");
    await check("a key turns the object about, without the divider", () => get("turn").getAttribute("aria-pressed") === "true" && get("divider").hidden);
    key(canvas, "ArrowRight");
    await check("the address has the turn", () => /turned=-20,8/.test(location.hash));
    key(canvas, "t");
    key(canvas, "m");
    await check("a key shows the next map", () => document.querySelector("#shows :checked").value === "shape");
    const fitted = get("zoom-level").textContent;
    canvas.dispatchEvent(new WheelEvent("wheel", { deltaY: -400, clientX: 300, clientY: 300, cancelable: true }));
    await check("the wheel zooms", () => parseInt(get("zoom-level").textContent, 10) > parseInt(fitted, 10));
    key(canvas, "0");
    await check("a key fits the picture", () => get("zoom-level").textContent === fitted);
    document.querySelector("#shows [value=relit]").click();
}

async function rooms() {
    const area = get("harmonics");
    document.querySelector("#rooms [value=overcast]").click();
    await check("a room shows its coefficients", () => area.value.split("\n").length === 9 && /env=overcast/.test(location.hash));
    area.value = "1 2 3";
    area.dispatchEvent(new Event("input", { bubbles: true }));
    await check("too few coefficients are refused", () => area.getAttribute("aria-invalid") === "true");
    area.value = Array.from({ length: 9 }, (_, k) => (k ? "0 0 0" : "3.5 3.5 3.5")).join("\n");
    area.dispatchEvent(new Event("input", { bubbles: true }));
    await check("coefficients are a room", () => /sh=3.5,3.5,3.5,0/.test(location.hash));
    const dropped = new DataTransfer();
    dropped.items.add(new File(["no picture at all"], "words.hdr"));
    dispatchEvent(new DragEvent("drop", { dataTransfer: dropped, cancelable: true }));
    await check("a file that is no picture is refused by name", () => !get("trouble").hidden && /^words.hdr cannot be used/.test(get("trouble").textContent));
    document.querySelector("#rooms [value=none]").click();
}

async function saving() {
    let saved = null;
    const make = URL.createObjectURL;
    URL.createObjectURL = (blob) => make.call(URL, (saved = blob));
    HTMLAnchorElement.prototype.click = () => {};
    get("save").click();
    for (let i = 0; i < 100 && !saved; i++) await later();
    const side = JSON.parse(get("scene").textContent).side, picture = saved && (await createImageBitmap(saved));
    await check("the picture is saved whole", () => Boolean(picture) && picture.width === side && picture.height === side && saved.type === "image/png");
}

async function names() {
    const nameless = [...document.querySelectorAll("button, input, textarea, [tabindex='0'], [role]")].filter((element) => {
        const label = element.labels && [...element.labels].map((l) => l.textContent).join("");
        return !(element.getAttribute("aria-label") || element.getAttribute("aria-labelledby") || label || element.textContent.trim()) &&
            element.getAttribute("aria-hidden") !== "true" && !element.closest("[hidden]");
    });
    await check(`everything that can be used has a name ${nameless.map((e) => e.outerHTML).join(" ")}`, () => nameless.length === 0);
}

async function all() {
    try {
        await lamps();
        await views();
        await rooms();
        await saving();
        await names();
    } catch (error) {
        await check(error.stack, () => false);
    }
    return lines.join("\n");
}
