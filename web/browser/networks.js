// SPDX-License-Identifier: MIT
// The networks of merlin-lab export in ONNX Runtime.
import * as ort from "./ort.wasm.min.mjs";

// One thread where the server does not isolate the page (Cross-Origin-Opener-Policy and -Embedder-Policy).
export const threads = self.crossOriginIsolated ? Math.min(navigator.hardwareConcurrency || 1, 8) : 1;
ort.env.wasm.numThreads = threads;
ort.env.wasm.wasmPaths = new URL("./", import.meta.url).href;

// A file of the page's folder; told is given the share that has come.
export async function get(address, told) {
    let answer;
    try {
        answer = await fetch(new URL(address, import.meta.url));
    } catch {
        throw new Error(`${address} cannot be loaded: is the server of this page still there?`);
    }
    if (!answer.ok) throw new Error(`The page is incomplete: ${address} is missing (${answer.status}).`);
    const size = Number(answer.headers.get("content-length")), parts = [];
    let have = 0;
    for (const reader = answer.body.getReader(); ; ) {
        const { done, value } = await reader.read();
        if (done) break;
        parts.push(value);
        have += value.length;
        told?.(size >= have ? have / size : 0);
    }
    return new Uint8Array(await new Blob(parts).arrayBuffer());
}

export class Networks {
    sessions = new Map(); // by "merlin-any/maps"
    files = new Map(); // those that are being fetched: {bytes, share, told}
    last = null; // the last run, which the choice of a model and its first view share

    // What goes in and comes out, by networks.json of the models of the page: [network, name, channels, reduction, is input].
    static async list(models) {
        const values = [];
        for (const model of models) {
            const list = JSON.parse(new TextDecoder().decode(await get(`models/${model}/networks.json`)));
            for (const { file, inputs, outputs } of list.networks.filter((one) => one.file !== "relight.onnx")) // lamps are the viewer's
                for (const [these, is_input] of [[inputs, 1], [outputs, 0]])
                    for (const { name, channels, reduction } of these)
                        if (!name.includes("_features")) values.push([`${model}/${file.replace(/\.onnx$/, "")}`, name, channels, reduction, is_input]);
        }
        return values;
    }

    // Fetches a network's file, unless that has begun or is done.
    fetch(network) {
        if (this.sessions.has(network) || this.files.has(network)) return this.files.get(network);
        const file = { told: null };
        file.bytes = get(`models/${network}.onnx`, (share) => file.told?.(share));
        file.bytes.catch(() => this.files.delete(network)); // the next to ask tries again
        this.files.set(network, file);
        return file;
    }

    // Fetches them one after the other, so that an estimate need not wait, and none needs the server any more.
    async fetch_all(networks) {
        for (const network of networks) await this.fetch(network)?.bytes.catch(() => {});
    }

    // Loads a network, and tells which share of it is there.
    async session(network, told) {
        if (!this.sessions.has(network)) {
            const file = this.fetch(network);
            file.told = told;
            this.sessions.set(network, await ort.InferenceSession.create(await file.bytes, { executionProviders: ["wasm"], graphOptimizationLevel: "all" }));
            this.files.delete(network);
        }
        return this.sessions.get(network);
    }

    // inputs: {name: {shape, data}}. Gives the outputs by name.
    async run(network, inputs, told) {
        const same = this.last?.network === network && Object.entries(inputs).every(([name, { data }]) => equal(data, this.last.inputs[name].data));
        if (same) return this.last.outputs;
        const session = await this.session(network, told), feeds = {};
        for (const [name, { shape, data }] of Object.entries(inputs)) feeds[name] = new ort.Tensor("float32", data, shape);
        const results = await session.run(feeds, session.outputNames.filter((name) => !name.includes("_features"))), outputs = {};
        for (const [name, tensor] of Object.entries(results)) outputs[name] = tensor.data;
        this.last = { network, inputs, outputs };
        return outputs;
    }
}

function equal(one, other) {
    if (one.length !== other.length) return false;
    for (let i = 0; i < one.length; i++) if (one[i] !== other[i]) return false;
    return true;
}
