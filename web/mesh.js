// SPDX-License-Identifier: MIT
// The caster's pixels as triangles. Where depth jumps there is no surface between them.

// A jump: more than so many pixels' size, between corners of one square.
const STEEPEST = 8;

function connected(scene, camera, corners) {
    const d = scene.casterDepth, pixel = (2 * camera.tangent) / scene.caster.side;
    let near = Infinity, far = 0;
    for (const i of corners) {
        near = Math.min(near, d[2 * i]);
        far = Math.max(far, d[2 * i]);
    }
    return far - near <= STEEPEST * pixel * near;
}

// A square is in if the object is near it: the outline itself is cut by coverage.
function covered(scene, corners) {
    return corners.some((i) => scene.casterDepth[2 * i + 1] >= 0.5);
}

export function buildMesh(gl, scene, camera) {
    const side = scene.caster.side, index = [];
    for (let y = 0; y + 1 < side; y++)
        for (let x = 0; x + 1 < side; x++) {
            const a = y * side + x, b = a + 1, c = a + side, d = c + 1;
            if (!covered(scene, [a, b, c, d]) || !connected(scene, camera, [a, b, c, d])) continue;
            index.push(a, c, b, b, c, d);
        }
    const array = gl.createVertexArray();
    gl.bindVertexArray(array);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, new Uint32Array(index), gl.STATIC_DRAW);
    gl.bindVertexArray(null);
    return { array, count: index.length };
}
