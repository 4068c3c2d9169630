// SPDX-License-Identifier: MIT
// Reads a panorama of latitude and longitude: Radiance HDR, or a picture that the browser knows.
// All give {width, height, data}: linear red, green, blue by rows from the top.

const MOST_PIXELS = 1 << 25;

function decode(code) {
    const x = code / 255;
    return x <= 0.04045 ? x / 12.92 : ((x + 0.055) / 1.055) ** 2.4;
}

async function readPicture(file) {
    const bitmap = await createImageBitmap(file, { colorSpaceConversion: "none" });
    const shrink = Math.min(1, 1024 / bitmap.width), width = Math.round(bitmap.width * shrink);
    const height = Math.round(bitmap.height * shrink);
    const canvas = new OffscreenCanvas(width, height), context = canvas.getContext("2d", { willReadFrequently: true });
    context.imageSmoothingQuality = "high";
    context.drawImage(bitmap, 0, 0, width, height);
    const bytes = context.getImageData(0, 0, width, height).data, table = Float32Array.from({ length: 256 }, (_, i) => decode(i));
    const data = new Float32Array(3 * width * height);
    for (let i = 0; i < width * height; i++) for (let c = 0; c < 3; c++) data[3 * i + c] = table[bytes[4 * i + c]];
    return { width, height, data };
}

// ---- Radiance HDR ----

class HdrReader {
    constructor(bytes) {
        this.bytes = bytes;
        this.at = 0;
    }

    line() {
        const end = this.bytes.indexOf(10, this.at);
        if (end < 0 || end - this.at > 4096) throw new Error("its head does not end");
        const text = String.fromCharCode(...this.bytes.subarray(this.at, end));
        this.at = end + 1;
        return text.trim();
    }

    byte() {
        if (this.at >= this.bytes.length) throw new Error("it ends too early");
        return this.bytes[this.at++];
    }

    head() {
        if (!this.line().startsWith("#?")) throw new Error("it is no Radiance HDR");
        for (let line = this.line(); line !== ""; line = this.line())
            if (line.startsWith("FORMAT=") && line !== "FORMAT=32-bit_rle_rgbe") throw new Error(`its ${line} is not read here`);
        const size = /^-Y (\d+) \+X (\d+)$/.exec(this.line());
        if (!size) throw new Error("its rows do not run from the top left");
        const [height, width] = [Number(size[1]), Number(size[2])];
        if (!(width > 0 && height > 0 && width * height <= MOST_PIXELS)) throw new Error(`it has ${width} × ${height} pixels`);
        return { width, height };
    }

    // One row of four bytes a pixel; of the new kind each byte's plane is packed by itself.
    row(width, out) {
        const [a, b, c, d] = [this.byte(), this.byte(), this.byte(), this.byte()];
        if (a !== 2 || b !== 2 || ((c << 8) | d) !== width || width < 8) {
            this.at -= 4;
            this.flatRow(width, out);
            return;
        }
        for (let plane = 0; plane < 4; plane++)
            for (let x = 0; x < width;) {
                const count = this.byte(), run = count > 128, length = run ? count - 128 : count;
                if (length === 0 || x + length > width) throw new Error("a row is damaged");
                const value = run ? this.byte() : 0;
                for (let i = 0; i < length; i++, x++) out[4 * x + plane] = run ? value : this.byte();
            }
    }

    // Pixels as they are, but that 1, 1, 1, n repeats the one before.
    flatRow(width, out) {
        for (let x = 0, shift = 0; x < width;) {
            const pixel = [this.byte(), this.byte(), this.byte(), this.byte()];
            if (pixel[0] === 1 && pixel[1] === 1 && pixel[2] === 1 && x > 0) {
                for (let n = pixel[3] << shift; n > 0 && x < width; n--, x++) out.copyWithin(4 * x, 4 * x - 4, 4 * x);
                shift += 8;
            } else {
                out.set(pixel, 4 * x++);
                shift = 0;
            }
        }
    }
}

function readHdr(bytes) {
    const reader = new HdrReader(bytes), { width, height } = reader.head();
    const data = new Float32Array(3 * width * height), row = new Uint8Array(4 * width);
    for (let y = 0; y < height; y++) {
        reader.row(width, row);
        for (let x = 0; x < width; x++) {
            const scale = row[4 * x + 3] ? 2 ** (row[4 * x + 3] - 136) : 0, to = 3 * (y * width + x);
            for (let c = 0; c < 3; c++) data[to + c] = row[4 * x + c] * scale;
        }
    }
    return { width, height, data };
}

export async function readPanorama(file) {
    const head = new Uint8Array(await file.slice(0, 2).arrayBuffer());
    const hdr = head[0] === 0x23 && head[1] === 0x3f;
    try {
        const map = hdr ? readHdr(new Uint8Array(await file.arrayBuffer())) : await readPicture(file);
        if (!map.data.some((x) => x > 0)) throw new Error("it is black all over");
        return map;
    } catch (error) {
        throw new Error(`${file.name} cannot be used as a room: ${error instanceof DOMException ? "it is no picture that this browser reads" : error.message}`);
    }
}
