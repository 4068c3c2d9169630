// SPDX-License-Identifier: MIT
// libmerlin in WebAssembly (web/browser/engine): its functions, and what it asks of the browser.
import { zlibSync } from "./fflate.js";
import { json_tree } from "./json_tree.js";

const TABLE = Uint32Array.from({ length: 256 }, (_, n) => {
    let c = n;
    for (let k = 0; k < 8; k++) c = c & 1 ? 0xedb88320 ^ (c >>> 1) : c >>> 1;
    return c;
});

function crc32(start, bytes) {
    let c = ~start;
    for (const b of bytes) c = TABLE[(c ^ b) & 255] ^ (c >>> 8);
    return ~c;
}

export const STOPPED = 6; // MERLIN_STOPPED

export class Engine {
    files = new Map(); // what page_write has written, by name

    static async start(program) {
        const engine = new Engine();
        const { instance } = await WebAssembly.instantiate(program, engine.imports());
        engine.calls = instance.exports;
        engine.calls._initialize();
        return engine;
    }

    // ---- memory ----

    bytes = (at, size) => new Uint8Array(this.calls.memory.buffer, at, size);
    floats = (at, count) => new Float32Array(this.calls.memory.buffer, at, count);

    allocate(size) {
        const at = this.calls.page_alloc(size);
        if (at) this.bytes(at, size).fill(0);
        return at;
    }

    free = (at) => this.calls.page_free(at);

    text_at(at) {
        const bytes = new Uint8Array(this.calls.memory.buffer, at);
        return new TextDecoder().decode(bytes.subarray(0, bytes.indexOf(0)));
    }

    // Memory with these bytes; 0 without memory.
    put(bytes) {
        const at = this.allocate(bytes.length || 1);
        if (at) this.bytes(at, bytes.length).set(bytes);
        return at;
    }

    put_text = (text) => this.put(new TextEncoder().encode(`${text}\0`));

    // ---- calls ----

    // Calls with texts and bytes as arguments; gives back what is returned.
    call(name, ...given) {
        const held = [];
        const values = given.map((one) => {
            if (typeof one === "number") return one;
            held.push(typeof one === "string" ? this.put_text(one) : this.put(one));
            if (!held.at(-1)) throw new Error("There is not enough memory for this photograph in this browser.");
            return held.at(-1);
        });
        const result = this.calls[name](...values);
        held.forEach(this.free);
        return result;
    }

    // Does the same for what returns a status: a failure is an Error with the engine's words.
    demand(name, ...given) {
        const status = this.call(name, ...given);
        if (status) throw new Error(this.sentence());
    }

    // The last failure as a sentence.
    sentence() {
        const words = this.text_at(this.calls.page_error());
        return `${words.charAt(0).toUpperCase()}${words.slice(1)}.`;
    }

    // ---- what it asks of the browser ----

    imports() {
        const number = (at, value, bytes = 4) => new DataView(this.calls.memory.buffer)[bytes === 8 ? "setBigUint64" : "setUint32"](at, value, true);
        return {
            env: {
                ...json_tree(this),
                page_file: (name, at, size) => this.files.set(this.text_at(name), this.bytes(at, size).slice()),
                libdeflate_alloc_compressor: (level) => level,
                libdeflate_free_compressor: () => {},
                libdeflate_zlib_compress_bound: (packer, size) => size + (size >> 3) + 1024,
                libdeflate_zlib_compress: (level, from, size, to, room) => {
                    const packed = zlibSync(this.bytes(from, size), { level: Math.min(level, 6) });
                    if (packed.length > room) return 0;
                    this.bytes(to, packed.length).set(packed);
                    return packed.length;
                },
                libdeflate_crc32: (start, at, size) => crc32(start, this.bytes(at, size)),
            },
            // Of a system it has a clock alone: nothing is opened, and nothing printed.
            wasi_snapshot_preview1: {
                clock_time_get: (id, precision, at) => (number(at, BigInt(Math.round(performance.now() * 1e6)), 8), 0),
                fd_close: () => 8,
                fd_fdstat_get: () => 8,
                fd_pread: () => 8,
                fd_read: () => 8,
                fd_seek: () => 8,
                fd_write: () => 8,
            },
        };
    }
}
