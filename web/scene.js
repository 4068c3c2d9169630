// SPDX-License-Identifier: MIT
// What the page holds: the maps as compressed planes of whole numbers (src/view/view_planes.c), each in a script element
// of its own, the photograph as a PNG, and what is known of them as JSON.

function bytesOf(id) {
    const element = document.getElementById(`map-${id}`);
    if (!element) return null;
    const text = atob(element.textContent);
    const bytes = new Uint8Array(text.length);
    for (let i = 0; i < text.length; i++) bytes[i] = text.charCodeAt(i);
    element.remove(); // the text is not needed again
    return bytes;
}

async function inflate(bytes) {
    const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
    return new Uint8Array(await new Response(stream).arrayBuffer());
}

// Each value is kept as its difference from left + above - above left, the sign in the lowest bit; all upper bytes first.
function unpack(bytes, width, height) {
    const count = width * height, out = new Uint16Array(count);
    for (let y = 0, i = 0; y < height; y++) {
        let row = 0; // the sum of this row's differences so far
        for (let x = 0; x < width; x++, i++) {
            const z = (bytes[i] << 8) | bytes[count + i];
            row += (z >> 1) ^ -(z & 1);
            out[i] = row + (y > 0 ? out[i - width] : 0);
        }
    }
    return out;
}

async function plane(id, width, height) {
    const bytes = bytesOf(id);
    return bytes && unpack(await inflate(bytes), width, height);
}

// Four planes side by side, as textures have them; a missing one is everywhere the given value.
function interleave(planes, missing) {
    const count = planes[0].length, out = new Uint16Array(4 * count);
    planes.forEach((p, c) => {
        for (let i = 0; i < count; i++) out[4 * i + c] = p ? p[i] : missing;
    });
    return out;
}

const MOST = 4095, LEAST_ROUGHNESS = 0.03;

export class Scene {
    // Takes the maps out of the page.
    static async read() {
        if (typeof DecompressionStream === "undefined") throw new Error("This browser is too old to open the maps: it knows no DecompressionStream.");
        const scene = new Scene(), told = JSON.parse(document.getElementById("scene").textContent), side = told.side;
        Object.assign(scene, told);
        const at = (id) => plane(id, side, side);
        const [red, green, blue, roughness] = [await at("red"), await at("green"), await at("blue"), await at("roughness")];
        const shape = [await at("normal-x"), await at("normal-y"), await at("depth"), await at("mask")];
        scene.material = interleave([red, green, blue, roughness], MOST);
        scene.shape = interleave(shape, 0);
        await scene.readCaster();
        const photo = bytesOf("photo");
        scene.photoFile = photo && new Blob([photo], { type: "image/png" });
        scene.photo = photo && (await createImageBitmap(scene.photoFile, { colorSpaceConversion: "none", premultiplyAlpha: "none" }));
        return scene;
    }

    // The surface that casts shadows, and its outline.
    async readCaster() {
        const { side, depth } = this.caster, count = side * side;
        const values = await plane("caster", side, side), on = await plane("caster-mask", side, side);
        this.casterDepth = new Float32Array(2 * count);
        for (let i = 0; i < count; i++) {
            this.casterDepth[2 * i] = depth[0] + (depth[1] - depth[0]) * (values[i] / 65535);
            this.casterDepth[2 * i + 1] = on[i];
        }
    }

    // The maps at a pixel; null off the object.
    at(x, y) {
        const i = 4 * (y * this.side + x), m = this.material, s = this.shape;
        if (s[i + 3] === 0) return null;
        const nx = s[i] / 4096 - 1, ny = s[i + 1] / 4096 - 1;
        return {
            albedo: [0, 1, 2].map((c) => (m[i + c] / MOST) ** 2),
            roughness: this.matte ? null : LEAST_ROUGHNESS * (1 / LEAST_ROUGHNESS) ** (m[i + 3] / MOST),
            normal: [nx, ny, Math.sqrt(Math.max(1 - nx * nx - ny * ny, 0))],
            depth: this.depth[0] + (this.depth[1] - this.depth[0]) * (s[i + 2] / 65535),
        };
    }
}
