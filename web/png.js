// SPDX-License-Identifier: MIT
// A picture as a PNG file, made here: a canvas would give it to the browser's colour management, and some browsers add
// noise to what is read from one.

const TABLE = Uint32Array.from({ length: 256 }, (_, n) => {
    let c = n;
    for (let k = 0; k < 8; k++) c = c & 1 ? 0xedb88320 ^ (c >>> 1) : c >>> 1;
    return c;
});

function crc(bytes) {
    let c = 0xffffffff;
    for (const b of bytes) c = TABLE[(c ^ b) & 255] ^ (c >>> 8);
    return (c ^ 0xffffffff) >>> 0;
}

function chunk(name, content) {
    const out = new Uint8Array(12 + content.length), view = new DataView(out.buffer);
    view.setUint32(0, content.length);
    for (let i = 0; i < 4; i++) out[4 + i] = name.charCodeAt(i);
    out.set(content, 8);
    view.setUint32(8 + content.length, crc(out.subarray(4, 8 + content.length)));
    return out;
}

async function deflate(bytes) {
    const stream = new Blob([bytes]).stream().pipeThrough(new CompressionStream("deflate"));
    return new Uint8Array(await new Response(stream).arrayBuffer());
}

// rgba: rows from the top, of which red, green and blue are kept; every row is told as its difference from the one above.
export async function encodePng(rgba, width, height) {
    const rows = new Uint8Array(height * (1 + 3 * width)), head = new DataView(new ArrayBuffer(13));
    for (let y = 0, to = 0; y < height; y++) {
        rows[to++] = 2;
        for (let x = 0; x < width; x++)
            for (let c = 0; c < 3; c++) {
                const at = 4 * (y * width + x) + c;
                rows[to++] = rgba[at] - (y > 0 ? rgba[at - 4 * width] : 0);
            }
    }
    head.setUint32(0, width);
    head.setUint32(4, height);
    head.setUint8(8, 8);
    head.setUint8(9, 2);
    const parts = [Uint8Array.of(0x89, 0x50, 0x4e, 0x47, 13, 10, 26, 10), chunk("IHDR", new Uint8Array(head.buffer)),
        chunk("sRGB", Uint8Array.of(0)), chunk("IDAT", await deflate(rows)), chunk("IEND", new Uint8Array(0))];
    return new Blob(parts, { type: "image/png" });
}
