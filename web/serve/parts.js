// SPDX-License-Identifier: MIT
// Small parts of the page.

// An element with attributes and children; on... attributes are listeners.
export function make(name, attributes, ...children) {
    const element = document.createElement(name);
    for (const [key, value] of Object.entries(attributes || {}))
        if (key.startsWith("on")) element.addEventListener(key.slice(2), value);
        else if (value === true) element.setAttribute(key, "");
        else if (value !== false && value !== undefined && value !== null) element.setAttribute(key, value);
    element.append(...children.filter((child) => child !== null && child !== undefined));
    return element;
}

export const byId = (id) => document.getElementById(id);

// Says something to screen readers, without moving anything.
export function say(words) {
    byId("said").textContent = words;
}

export function bytes(count) {
    if (count < 1000) return `${count} B`;
    return count < 1e6 ? `${(count / 1e3).toFixed(0)} kB` : `${(count / 1e6).toFixed(1)} MB`;
}

const carries_files = (e) => e.dataTransfer?.types.includes("Files");

// Calls take with files that are dropped anywhere on the page; #drop shows that they can be.
export function take_drops(take) {
    for (const kind of ["dragenter", "dragover"])
        addEventListener(kind, (e) => {
            if (!carries_files(e)) return;
            e.preventDefault();
            byId("drop").classList.add("over");
        });
    addEventListener("dragleave", (e) => { if (!e.relatedTarget) byId("drop").classList.remove("over"); });
    addEventListener("drop", (e) => {
        if (!carries_files(e)) return;
        e.preventDefault();
        byId("drop").classList.remove("over");
        take([...e.dataTransfer.files]);
    });
}
