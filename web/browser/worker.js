// SPDX-License-Identifier: MIT
// The estimate, beside the page so that it stays responsive: every message is a call {id, name, given}, answered by
// {id, result} or {id, error}, and before that by any number of {id, told}.
import { Engine, STOPPED } from "./engine.js";
import { Networks, get, threads } from "./networks.js";

const MODELS = ["merlin-any", "merlin-point"]; // the second is for flashes
const NETWORKS = ["merlin-any/maps", "merlin-point/maps", "merlin-point/bounces"];
const MOST_SIDE = 2048; // of a photograph; larger ones are reduced

const networks = new Networks();
let engine = null, turn = 0;

// A picture as the browser decodes it: upright by its EXIF, in sRGB; {bitmap, reduced}.
async function decode(file) {
    const how = { imageOrientation: "from-image", premultiplyAlpha: "none", colorSpaceConversion: "default" };
    const bitmap = await createImageBitmap(file, how).catch(() => {
        throw new Error("This browser cannot open this picture: choose a JPEG, PNG or WebP.");
    });
    const longest = Math.max(bitmap.width, bitmap.height);
    if (longest <= MOST_SIDE) return { bitmap, reduced: false };
    const to = (length) => Math.max(1, Math.round((length * MOST_SIDE) / longest));
    const size = { resizeWidth: to(bitmap.width), resizeHeight: to(bitmap.height), resizeQuality: "high" };
    bitmap.close();
    return { bitmap: await createImageBitmap(file, { ...how, ...size }), reduced: true };
}

function pixels_of(bitmap) {
    const context = new OffscreenCanvas(bitmap.width, bitmap.height).getContext("2d", { willReadFrequently: true, colorSpace: "srgb" });
    context.drawImage(bitmap, 0, 0);
    return context.getImageData(0, 0, bitmap.width, bitmap.height).data;
}

async function mask_picture(width, height) {
    const at = engine.allocate(width * height), picture = new ImageData(width, height);
    if (!at) throw new Error("There is not enough memory for this photograph in this browser.");
    engine.call("page_get_mask", at);
    engine.bytes(at, width * height).forEach((cover, i) => picture.data.set([cover, cover, cover, 255], 4 * i));
    engine.free(at);
    return createImageBitmap(picture);
}

const calls = {
    async start() {
        engine = await Engine.start(await get("merlin.wasm"));
        const values = await Networks.list(MODELS);
        for (const value of values) engine.demand("page_network", ...value);
        engine.demand("page_open", ...MODELS);
        return { threads, version: engine.text_at(engine.call("page_version")) };
    },

    // Takes a photograph and finds its object: {photo, mask, focal, reduced, confidence, trouble}.
    async take(told, file) {
        turn++;
        const { bitmap, reduced } = await decode(file), { width, height } = bitmap;
        engine.demand("page_photo", pixels_of(bitmap), width, height, ...(await bytes_of(file)));
        const found = { photo: bitmap, reduced, focal: engine.call("page_focal"), trouble: null, confidence: 0 };
        if (engine.call("page_find")) found.trouble = engine.sentence();
        else found.confidence = engine.call("page_confidence");
        found.mask = found.trouble ? null : await mask_picture(width, height);
        networks.fetch_all(NETWORKS);
        return found;
    },

    async set_mask(told, file) {
        const pixels = pixels_of(await createImageBitmap(file)), cover = new Uint8Array(pixels.length / 4);
        for (let i = 0; i < cover.length; i++) cover[i] = pixels[4 * i];
        engine.demand("page_set_mask", cover);
    },

    // how: {fov, flash, size, views, name}. Gives the files by name and the seconds; null if it was cancelled.
    async estimate(told, how) {
        const mine = ++turn, began = performance.now();
        let runs = 0;
        engine.demand("page_begin", how.fov, how.flash ? 1 : 0, how.size, how.views);
        networks.last = null;
        for (;;) {
            if (mine !== turn) return null;
            const status = engine.call("page_step");
            if (!status) break;
            if (status !== STOPPED || !engine.text_at(engine.call("page_run_network"))) throw new Error(engine.sentence());
            await answer(told, ++runs);
            await new Promise((done) => setTimeout(done)); // a message may be waiting that cancels
        }
        told({ stage: "Writing files" });
        engine.files.clear();
        engine.demand("page_write", how.name);
        return { files: new Map(engine.files), seconds: (performance.now() - began) / 1000 };
    },

    async cancel() {
        turn++;
    },
};

async function bytes_of(file) {
    const head = new Uint8Array(await file.slice(0, 1 << 22).arrayBuffer()); // EXIF stands at its beginning
    return [head, head.length];
}

// Runs the network that the engine waits for.
async function answer(told, run) {
    const network = engine.text_at(engine.call("page_run_network")), inputs = {};
    const value = (is_input, i) => {
        const channels = engine.call("page_run_channels", is_input, i), side = engine.call("page_run_side", is_input, i);
        return { name: engine.text_at(engine.call("page_run_name", is_input, i)), at: engine.call("page_run_data", is_input, i), channels, side };
    };
    for (let i = 0; i < engine.call("page_run_count", 1); i++) {
        const { name, at, channels, side } = value(1, i);
        inputs[name] = { shape: side > 1 ? [1, channels, side, side] : [1, channels], data: engine.floats(at, channels * side * side).slice() };
    }
    told({ stage: "Estimating", run, network });
    const outputs = await networks.run(network, inputs, (share) => told({ stage: "Loading the network", share }));
    for (let i = 0; i < engine.call("page_run_count", 0); i++) {
        const { name, at, channels, side } = value(0, i);
        engine.floats(at, channels * side * side).set(outputs[name]);
    }
    engine.call("page_answered");
}

function words_of(error) {
    if (error instanceof RangeError || error instanceof WebAssembly.RuntimeError || /memory|alloc|abort/i.test(error.message))
        return `There is not enough memory in this browser: close other tabs, load this page anew, or choose “Quick”. (${error.message})`;
    return error.message || String(error);
}

self.onmessage = async ({ data: { id, name, given } }) => {
    try {
        const result = await calls[name]((told) => self.postMessage({ id, told }), ...given);
        self.postMessage({ id, result });
    } catch (error) {
        console.error(error);
        self.postMessage({ id, error: words_of(error) });
    }
};
