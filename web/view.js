// SPDX-License-Identifier: MIT
// Where the picture is on the screen: zoom, place, and how it is turned about. Lengths are in the screen's pixels.
import { clamp } from "./vector.js";

const MOST_ZOOM = 32, ROOM_AROUND = 0.9, MOST_YAW = 80, MOST_PITCH = 70;

export class View {
    constructor(side) {
        this.side = side; // the picture's, in its own pixels
        this.width = this.height = 1;
        this.fitted = true;
        this.scale = 1; // screen pixels a pixel of the picture
        this.x = this.y = 0; // where its upper left corner is
    }

    resize(width, height, ratio) {
        [this.width, this.height, this.ratio] = [width, height, ratio];
        if (this.fitted) this.fit();
        else this.settle();
    }

    fitScale() {
        return (Math.min(this.width, this.height) * ROOM_AROUND) / this.side;
    }

    fit() {
        this.fitted = true;
        this.scale = this.fitScale();
        this.x = (this.width - this.scale * this.side) / 2;
        this.y = (this.height - this.scale * this.side) / 2;
    }

    // By a factor, about a place that stays where it is.
    zoomBy(factor, x = this.width / 2, y = this.height / 2) {
        const least = this.fitScale(), wanted = clamp(this.scale * factor, least, Math.max(MOST_ZOOM * this.ratio, least));
        if (wanted <= least * 1.001) {
            this.fit();
            return;
        }
        this.x = x - ((x - this.x) * wanted) / this.scale;
        this.y = y - ((y - this.y) * wanted) / this.scale;
        this.scale = wanted;
        this.fitted = false;
        this.settle();
    }

    move(dx, dy) {
        if (this.fitted) return;
        this.x += dx;
        this.y += dy;
        this.settle();
    }

    // The picture does not leave the screen: its edge goes at most to the middle.
    settle() {
        const size = this.scale * this.side;
        this.x = clamp(this.x, this.width / 2 - size, this.width / 2);
        this.y = clamp(this.y, this.height / 2 - size, this.height / 2);
    }

    // Shares of the picture from its upper left corner, and back.
    placeAt(x, y) {
        const size = this.scale * this.side;
        return [(x - this.x) / size, (y - this.y) / size];
    }

    screenAt([u, v]) {
        const size = this.scale * this.side;
        return [this.x + u * size, this.y + v * size];
    }
}

export function turnedBy(solid, right, down) {
    return { yaw: clamp(solid.yaw + right, -MOST_YAW, MOST_YAW), pitch: clamp(solid.pitch + down, -MOST_PITCH, MOST_PITCH) };
}

// The rows of the rotation that shows the surface so: yaw to the right, then pitch downward.
export function rotationOf({ yaw, pitch }) {
    const a = (yaw * Math.PI) / 180, b = (pitch * Math.PI) / 180;
    const [ca, sa, cb, sb] = [Math.cos(a), Math.sin(a), Math.cos(b), Math.sin(b)];
    return [[ca, 0, sa], [sb * sa, cb, -sb * ca], [-cb * sa, sb, cb * ca]];
}

export const rotated = (m, v) => m.map((row) => row[0] * v[0] + row[1] * v[1] + row[2] * v[2]);
export const unrotated = (m, v) => [0, 1, 2].map((c) => m[0][c] * v[0] + m[1][c] * v[1] + m[2][c] * v[2]);
