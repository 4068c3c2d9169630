// SPDX-License-Identifier: MIT
// Draws the picture: lamps with their shadows, the room's light, maps; flat or as a surface that is turned about.
import { Program, fill, levelsOf, makeTarget, makeTexture } from "./gl.js";
import { buildMesh } from "./mesh.js";
import { RoomLight } from "./room_light.js";
import { Camera, product } from "./vector.js";

export const LIGHT_POWER = 5.95, MOST_LAMPS = 4;
const SHADOW_SIDE = 512, BACKDROP = [0.0065, 0.0065, 0.0068], BLACK = [0, 0, 0];
const SURFACE = ["surface.glsl", "camera.glsl"], WHOLE = ["whole.vert.glsl"];
const MAPS = ["albedo", "normal", "roughness", "depth"];

export class Renderer {
    constructor(gl, scene) {
        this.gl = gl;
        this.scene = scene;
        this.camera = new Camera(scene.tangent, scene.slant);
        this.backdrop = BACKDROP;
        this.makeTextures();
        this.programs = {
            shadow: new Program(gl, WHOLE, ["camera.glsl", "shadow.frag.glsl"]),
            relit: new Program(gl, WHOLE, [...SURFACE, "brdf.glsl", "relit.frag.glsl"]),
            map: new Program(gl, WHOLE, [...SURFACE, "color.glsl", "map.frag.glsl"]),
            photo: new Program(gl, WHOLE, [...SURFACE, "color.glsl", "photo.frag.glsl"]),
            display: new Program(gl, WHOLE, ["color.glsl", "display.frag.glsl"]),
            mesh: new Program(gl, ["camera.glsl", "mesh.vert.glsl"],
                [...SURFACE, "brdf.glsl", "color.glsl", "mesh.frag.glsl"]),
        };
        this.room = new RoomLight(gl, scene, this.shared);
        if (scene.photo) this.drawPhoto();
    }

    makeTextures() {
        const gl = this.gl, scene = this.scene, side = scene.side, levels = levelsOf(side);
        this.material = makeTexture(gl, "rgba16ui", side, side, { data: scene.material });
        this.shape = makeTexture(gl, "rgba16ui", side, side, { data: scene.shape });
        const caster = scene.caster.side;
        this.caster = makeTexture(gl, "rg32f", caster, caster, { data: scene.casterDepth });
        this.shadowSide = Math.min(side, 2 * caster, SHADOW_SIDE);
        this.shadows = Array.from({ length: MOST_LAMPS }, () =>
            makeTarget(gl, [makeTexture(gl, "r16f", this.shadowSide, this.shadowSide, { smooth: true })]));
        this.cast = new Array(MOST_LAMPS).fill(""); // for which lamp each was drawn
        this.picture = makeTarget(gl, [makeTexture(gl, "srgb8", side, side, { smooth: true, levels })]);
        const photo = scene.photo ? side : 1; // a page without one compares nothing
        this.other = makeTarget(gl, [makeTexture(gl, "srgb8", photo, photo, { smooth: true, levels: levelsOf(photo) })]);
        this.shared = {
            material: this.material, shape: this.shape, depth_range: scene.depth, caster: this.caster, matte: scene.matte,
            ...this.camera.uniforms(),
        };
    }

    mipmaps(target) {
        const gl = this.gl, texture = target.textures[0];
        gl.activeTexture(gl.TEXTURE0);
        gl.bindTexture(texture.kind, texture.handle);
        gl.generateMipmap(texture.kind);
    }

    drawPhoto() {
        const gl = this.gl, side = this.scene.side;
        const photo = makeTexture(gl, "rgba8", side, side, { data: this.scene.photo });
        fill(gl, this.other, this.programs.photo, { ...this.shared, photo });
        this.mipmaps(this.other);
        gl.deleteTexture(photo.handle);
    }

    // A flash at the lens casts none: the camera sees nothing that its flash does not.
    castShadow(i, lamp) {
        const wanted = JSON.stringify([lamp.at, lamp.far]);
        if (this.cast[i] === wanted) return;
        this.cast[i] = wanted;
        const gl = this.gl, target = this.shadows[i];
        if (!lamp.far && Math.hypot(...lamp.at) < 1e-6) {
            gl.bindFramebuffer(gl.FRAMEBUFFER, target.handle);
            gl.clearBufferfv(gl.COLOR, 0, [1, 1, 1, 1]);
            return;
        }
        fill(gl, target, this.programs.shadow, {
            ...this.shared, light_at: lamp.at, light_far: lamp.far,
            caster_span: [this.scene.caster.nearest, this.scene.caster.farthest],
        });
    }

    // lamps: [{at, far, light}], light being Φ by channel; room: its light's scale by channel or null.
    lightUniforms(light) {
        const lamps = light.lamps;
        lamps.forEach((lamp, i) => this.castShadow(i, lamp));
        const pad = (list, n, rest) => [...list, ...new Array(n * (MOST_LAMPS - lamps.length)).fill(rest)];
        const uniforms = {
            ...this.shared,
            lamp_count: lamps.length,
            lamp_at: pad(lamps.flatMap((l) => l.at), 3, 0),
            lamp_far: pad(lamps.map((l) => Number(l.far)), 1, 0),
            lamp_light: pad(lamps.flatMap((l) => l.light), 3, 0),
            white: light.white,
            plain: light.plain,
            matte: this.scene.matte || light.plain,
            room: this.room.texture(),
            room_scale: light.room ? light.room : BLACK,
        };
        this.shadows.forEach((s, i) => (uniforms[`seen_${i}`] = s.textures[0]));
        return uniforms;
    }

    // Fills the picture by what is to be seen; true where the room's light is still to be refined.
    draw(show, light) {
        const gl = this.gl, map = MAPS.indexOf(show);
        if (map >= 0) {
            fill(gl, this.picture, this.programs.map, { ...this.shared, which: map, depth_span: this.scene.object });
        } else if (show === "photo") {
            const photo = this.other;
            gl.bindFramebuffer(gl.READ_FRAMEBUFFER, photo.handle);
            gl.bindFramebuffer(gl.DRAW_FRAMEBUFFER, this.picture.handle);
            const side = this.scene.side;
            gl.blitFramebuffer(0, 0, side, side, 0, 0, side, side, gl.COLOR_BUFFER_BIT, gl.NEAREST);
        } else {
            fill(gl, this.picture, this.programs.relit, this.lightUniforms(light));
        }
        this.mipmaps(this.picture);
    }

    // view: {width, height, x, y, scale, divider} in screen pixels.
    display(view) {
        const gl = this.gl;
        gl.viewport(0, 0, view.width, view.height);
        fill(gl, null, this.programs.display, {
            picture: this.picture.textures[0], other: this.other.textures[0], view_size: [view.width, view.height],
            origin: [view.x, view.y], scale: view.scale, divider: view.divider, sharp: view.scale >= 3, backdrop: this.backdrop,
        });
    }

    // The picture as it is, small, as the bytes of a canvas.
    small(side) {
        const gl = this.gl, target = makeTarget(gl, [makeTexture(gl, "rgba8", side, side)]), out = new Uint8Array(4 * side * side);
        fill(gl, target, this.programs.display, {
            picture: this.picture.textures[0], other: this.other.textures[0], view_size: [side, side], origin: [0, 0],
            scale: side / this.scene.side, divider: -1, sharp: false, backdrop: this.backdrop,
        });
        gl.bindFramebuffer(gl.FRAMEBUFFER, target.handle);
        gl.readPixels(0, 0, side, side, gl.RGBA, gl.UNSIGNED_BYTE, out);
        gl.bindFramebuffer(gl.FRAMEBUFFER, null);
        gl.deleteFramebuffer(target.handle);
        gl.deleteTexture(target.textures[0].handle);
        const rows = new Uint8Array(out.length); // the screen's first row is its last one
        for (let y = 0; y < side; y++) rows.set(out.subarray(4 * side * y, 4 * side * (y + 1)), 4 * side * (side - 1 - y));
        return rows;
    }

    // The surface, turned by `turn` (about its middle: rows of a rotation) and drawn where the flat picture would be.
    displayMesh(view, turn, light, painted) {
        const gl = this.gl;
        if (!this.mesh) this.mesh = buildMesh(gl, this.scene, this.camera);
        const { matrix, eye } = this.turned(view, turn), uniforms = this.lightUniforms(light);
        gl.bindFramebuffer(gl.FRAMEBUFFER, null);
        gl.viewport(0, 0, view.width, view.height);
        const b = this.backdrop.map((x) => (x <= 0.0031308 ? 12.92 * x : 1.055 * x ** (1 / 2.4) - 0.055));
        gl.clearColor(b[0], b[1], b[2], 1);
        gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
        gl.enable(gl.DEPTH_TEST);
        gl.enable(gl.SAMPLE_ALPHA_TO_COVERAGE);
        this.programs.mesh.set({
            ...uniforms, view: matrix, eye, painted, picture: this.picture.textures[0],
        });
        gl.bindVertexArray(this.mesh.array);
        gl.drawElements(gl.TRIANGLES, this.mesh.count, gl.UNSIGNED_INT, 0);
        gl.bindVertexArray(null);
        gl.disable(gl.DEPTH_TEST);
        gl.disable(gl.SAMPLE_ALPHA_TO_COVERAGE);
    }

    middle() {
        const { nearest, farthest } = this.scene.caster;
        return [0, 0, -0.5 * (nearest + farthest)];
    }

    // To the screen, and where the eye is as the surface sees it.
    turned(view, turn) {
        const m = this.middle(), rotation = new Float32Array(16), back = [0, 0, 0];
        for (let r = 0; r < 3; r++) {
            for (let c = 0; c < 3; c++) rotation[4 * c + r] = turn[r][c];
            rotation[12 + r] = m[r] - turn[r][0] * m[0] - turn[r][1] * m[1] - turn[r][2] * m[2];
        }
        rotation[15] = 1;
        for (let c = 0; c < 3; c++) back[c] = m[c] - (turn[0][c] * m[0] + turn[1][c] * m[1] + turn[2][c] * m[2]);
        // the picture's square to its place on the screen
        const side = view.scale * this.scene.side, sx = side / view.width, sy = side / view.height;
        const place = new Float32Array([sx, 0, 0, 0, 0, sy, 0, 0, 0, 0, 1, 0,
            (2 * view.x + side) / view.width - 1, 1 - (2 * view.y + side) / view.height, 0, 1]);
        const matrix = product(place, product(this.camera.matrix(0.02, 20), rotation));
        return { matrix, eye: back };
    }

    // The picture's bytes, red, green, blue, coverage by rows from the top.
    bytes() {
        const gl = this.gl, side = this.scene.side, out = new Uint8Array(4 * side * side);
        gl.bindFramebuffer(gl.FRAMEBUFFER, this.picture.handle);
        gl.readPixels(0, 0, side, side, gl.RGBA, gl.UNSIGNED_BYTE, out);
        gl.bindFramebuffer(gl.FRAMEBUFFER, null);
        return out;
    }
}
