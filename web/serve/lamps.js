// SPDX-License-Identifier: MIT
// Pictures of the object under other light, as files: what a hand does in the viewer, done by the server with all of the
// network's light.
import { follow, submit } from "./api.js";
import { make, say } from "./parts.js";

const places = { left: "-0.8,0.3,-0.5", right: "0.8,0.3,-0.5", above: "0,0.9,-0.6", below: "0,-0.9,-0.6", flash: "0,0,0" };
const names = { left: "From the left", right: "From the right", above: "From above", below: "From below", flash: "At the lens", own: "A lamp at x, y, z", orbit: "A lamp on an orbit, 12 pictures", room: "A room (panorama)" };

export function lamps(job, title) {
    const where = make("select", { "aria-label": "Light" }, ...Object.entries(names).map(([value, words]) => make("option", { value }, words)));
    const place = make("input", { type: "text", value: "0.7,0.3,-0.4", "aria-label": "Place of the lamp, x, y, z", inputmode: "text", hidden: true });
    const room = make("input", { type: "file", accept: ".hdr,.exr,.pic", "aria-label": "Panorama", hidden: true });
    const button = make("button", { type: "submit" }, "Light it");
    const words = make("p", { role: "status", class: "dim" });
    const pictures = make("div", { class: "pictures" });
    where.addEventListener("change", () => {
        place.hidden = where.value !== "own";
        room.hidden = where.value !== "room";
    });
    const form = make("form", { class: "row" }, where, place, room, button);
    form.addEventListener("submit", async (e) => {
        e.preventDefault();
        if (where.value === "room" && !room.files.length) return void (words.textContent = "Choose a panorama, .hdr or .exr.");
        const field = where.value === "room" ? ["environment", room.files[0]] : where.value === "orbit" ? ["orbit", "12"] : ["light", places[where.value] || place.value];
        button.disabled = true;
        words.textContent = "Lighting";
        try {
            const now = await follow(await submit("relight", [["job", job.id], field], null), () => {});
            if (now.state !== "done") throw new Error(now.error || "It was cancelled.");
            const label = `${title}: ${names[where.value].toLowerCase()}`;
            pictures.prepend(...now.files.map((file) => make("a", { href: file.url, download: file.name }, make("img", { src: file.url, alt: label }))));
            words.textContent = "";
            say(`${label} is done`);
        } catch (error) {
            words.textContent = error.message;
        }
        button.disabled = false;
    });
    return make("details", {}, make("summary", {}, "Pictures in other light"), form, words, pictures);
}
