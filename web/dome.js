// SPDX-License-Identifier: MIT
// Where a lamp stands for a place on the picture: on a dome over the object, whose middle is (0, 0, -1) and which is as
// high as the lamp's height; at height 1 it is the frontal hemisphere, from all of which the object is lit alike. Near
// the middle the lamp is over what lies under the pointer; the picture's edge is the dome's foot.
import { clamp } from "./vector.js";

const FOOT = 0.03; // a lamp at the very foot would graze

export class Dome {
    constructor(camera) {
        this.camera = camera;
        this.edge = camera.tangent;
    }

    // From the distance to the middle in the plane at depth 1 to the lamp's, and back.
    outward(r) {
        const s = r / this.edge;
        return Math.min(this.edge < 1 ? r * (1 + (1 / this.edge - 1) * s * s) : s, 1);
    }

    inward(distance) {
        let low = 0, high = this.edge;
        for (let i = 0; i < 30; i++) {
            const middle = (low + high) / 2;
            if (this.outward(middle) < distance) low = middle;
            else high = middle;
        }
        return low * Math.max(distance, 1); // beyond the foot it goes on
    }

    // x, y in the plane at depth 1 to a place in the camera's space.
    lampOver([x, y], height) {
        const r = Math.hypot(x, y) || 1e-9, distance = this.outward(r), scale = distance / r;
        return [x * scale, y * scale, Math.max(height * Math.sqrt(1 - distance * distance), FOOT) - 1];
    }

    // Back again.
    under([x, y]) {
        const distance = Math.hypot(x, y) || 1e-9, scale = this.inward(distance) / distance;
        return [x * scale, y * scale];
    }

    heightOf([x, y, z]) {
        return clamp((z + 1) / Math.sqrt(Math.max(1 - x * x - y * y, 0.02)), 0.05, 2);
    }

    // The same place on the dome, with another height.
    raised([x, y], height) {
        return [x, y, Math.max(height * Math.sqrt(Math.max(1 - x * x - y * y, 0)), FOOT) - 1];
    }
}
