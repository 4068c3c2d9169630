/* SPDX-License-Identifier: MIT */
/* A page's script for tools/compare-openlime: shows a folder, whose files the page has in `files` as data: addresses, in
 * OpenLIME, without a server. `light` lights it and waits until it is drawn. */
const said = [];
window.onerror = (message) => said.push(message);
window.onunhandledrejection = (event) => said.push(String(event.reason));

const own = (url) => files[String(url).split('/').pop()] || url;
const fetched = window.fetch;
window.fetch = (url, options) => fetched(own(url), options);
const source = Object.getOwnPropertyDescriptor(HTMLImageElement.prototype, 'src');
Object.defineProperty(HTMLImageElement.prototype, 'src', {
    get() { return source.get.call(this); },
    set(url) { source.set.call(this, own(url)); },
});

const viewer = new OpenLIME.Viewer('#openlime', { background: 'black' });
const layer = new OpenLIME.Layer({ layout: 'image', type: 'rti', url: 'info.json' });
viewer.addLayer('rti', layer);

async function wait() {
    const there = () => layer.tiles.size > 0 && [...layer.tiles.values()].every((tile) => tile.missing === 0);
    for (let i = 0; i < 200 && !there(); i++) await new Promise((done) => setTimeout(done, 100));
    const trouble = document.getElementById('trouble');
    trouble.hidden = there();
    trouble.textContent = there() ? '' : 'OpenLIME does not show it: ' + said.join('; ');
    document.documentElement.dataset.ready = '';
}
wait();

async function light(x, y) {
    layer.setLight([x, y], 0);
    viewer.redraw();
    await new Promise((done) => setTimeout(done, 300));
    return said.join('; ');
}
