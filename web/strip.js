// SPDX-License-Identifier: MIT
// The row of small pictures below, one for each thing that can be shown.

const SMALL = 116;

function paint(viewer, show, canvas) {
    const renderer = viewer.renderer;
    renderer.draw(show, viewer.light(show));
    const bytes = renderer.small(SMALL), context = canvas.getContext("2d");
    const image = context.createImageData(SMALL, SMALL);
    image.data.set(bytes);
    context.putImageData(image, 0, 0);
}

export function makeStrip(viewer, names) {
    const box = document.getElementById("shows"), inputs = new Map();
    for (const show of viewer.shows) {
        const label = document.createElement("label"), input = document.createElement("input"), canvas = document.createElement("canvas");
        Object.assign(canvas, { width: SMALL, height: SMALL });
        canvas.setAttribute("aria-hidden", "true");
        Object.assign(input, { type: "radio", name: "show", value: show });
        input.addEventListener("change", () => viewer.show(show));
        label.append(input, canvas, names[show]);
        box.append(label);
        paint(viewer, show, canvas);
        inputs.set(show, input);
    }
    viewer.strip = {
        choose(show) {
            for (const [name, input] of inputs) input.checked = name === show;
        },
    };
}
