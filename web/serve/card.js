// SPDX-License-Identifier: MIT
// What one upload becomes: a picture, how far its job is, and what came of it.
import { follow, remove, submit } from "./api.js";
import { lamps } from "./lamps.js";
import { correct } from "./mask.js";
import { find_object } from "./object.js";
import { bytes, make, say } from "./parts.js";

const stages = {
    reading: "Reading", "finding the object": "Finding the object", estimating: "Estimating", refining: "Refining normals",
    solving: "Solving", integrating: "Integrating", relighting: "Lighting", writing: "Writing files",
};
const first = ["viewer.html", "overview.png", "maps.exr", "mesh.glb"];

function files_of(job) {
    const order = (name) => (first.indexOf(name) + first.length + 1) % (first.length + 1);
    const sorted = [...job.files].sort((a, b) => (first.includes(b.name) - first.includes(a.name)) || order(a.name) - order(b.name));
    return sorted.map((file) => make("li", {}, make("a", { href: file.url, download: file.name }, file.name), " ",
        make("span", { class: "dim" }, bytes(file.bytes))));
}

function words_of(now) {
    if (now.state === "queued") return now.position ? `Waiting: ${now.position} before it` : "Waiting";
    return stages[now.stage] || "Working";
}

function summary_of(job) {
    const seconds = job.ended - job.created, by = job.report?.model || job.report?.method;
    return `${by ? `Done by ${by}` : "Done"}, ${seconds ? `${seconds} s` : "less than a second"}`;
}

export class Card {
    // files, fields: what is sent, pairs of a name and a file or value; one photograph can have its mask corrected.
    constructor(list, title, kind, files, fields) {
        Object.assign(this, { title, kind, files, fields, photo: kind === "estimate" ? files[0][1] : null, painted: null, turn: 0 });
        const picture = files.find(([, file]) => file.type.startsWith("image/"));
        this.address = picture ? URL.createObjectURL(picture[1]) : null;
        this.bar = make("progress", { max: 1, value: 0, "aria-label": `Progress of ${title}` });
        this.words = make("p", { class: "dim" });
        this.body = make("div", { class: "body" });
        this.mask = this.photo && make("button", { type: "button", "aria-label": `Correct the mask of ${title}`, onclick: () => this.repaint() }, "Mask…");
        this.button = make("button", { type: "button", onclick: () => this.leave() });
        this.root = make("li", { class: "card", "aria-label": title },
            make("div", { class: "head" },
                this.address && make("img", { src: this.address, alt: "", onerror: (e) => e.target.remove() }),
                make("div", { class: "what" }, make("h3", {}, title), this.words, this.bar),
                make("div", { class: "buttons" }, this.mask, this.button)), this.body);
        list.prepend(this.root);
        this.run();
    }

    name_button(words) {
        this.button.textContent = words;
        this.button.setAttribute("aria-label", `${words} ${this.title}`);
    }

    // Sends the files and follows their job, unless another turn of this card begins before.
    async run() {
        const turn = ++this.turn, fields = [...this.fields, ...this.files, ...(this.painted ? [["mask", this.painted]] : [])];
        const gone = () => turn !== this.turn;
        this.bar.hidden = false;
        this.bar.value = 0;
        this.words.className = "dim";
        this.words.textContent = "Sending";
        this.body.replaceChildren();
        this.name_button("Cancel");
        try {
            const job = await submit(this.kind, fields, (share) => { if (!gone()) this.bar.value = 0.1 * share; });
            if (gone()) return void remove(job).catch(() => {});
            this.job = job;
            const now = await follow(job, (told) => {
                if (gone()) return;
                this.words.textContent = words_of(told);
                this.bar.value = 0.1 + 0.9 * told.progress;
            });
            if (gone() || now.state === "cancelled") return;
            if (now.state === "failed") throw new Error(now.error);
            this.job = now;
            this.done();
        } catch (error) {
            if (!gone()) this.fail(error.message);
        }
    }

    fail(words) {
        this.words.textContent = words;
        this.words.className = "wrong";
        this.bar.hidden = true;
        this.name_button("Remove");
        say(`${this.title}: ${words}`);
    }

    done() {
        const job = this.job, view = job.files.find((file) => file.name === "viewer.html");
        this.bar.hidden = true;
        this.name_button("Remove");
        this.words.textContent = summary_of(job);
        for (const warning of job.report?.warnings || []) this.body.append(make("p", { class: "warning" }, warning.message));
        if (view)
            this.body.append(make("iframe", { src: view.url, title: `Viewer of ${this.title}`, allow: "fullscreen" }),
                make("p", {}, make("a", { href: view.url, target: "_blank", rel: "noopener" }, "Open the viewer in a tab of its own")));
        this.body.append(make("details", {}, make("summary", {}, `Files (${job.files.length})`),
            make("p", {}, make("a", { href: `${job.url}/files.zip`, download: `${this.title.replace(/\.[^.]*$/, "")}.zip` }, "All of them, as a ZIP archive")), make("ul", { class: "files" }, ...files_of(job))));
        if (job.files.some((file) => file.name === "maps.exr")) this.body.append(lamps(job, this.title));
        say(`${this.title} is done`);
    }

    async repaint() {
        const painted = await correct(this.photo, this.painted, find_object);
        if (!painted) return this.mask.focus();
        this.painted = painted;
        if (this.job) remove(this.job).catch(() => {});
        this.job = null;
        this.run();
        this.mask.focus();
    }

    leave() {
        this.turn++;
        if (this.job) remove(this.job).catch(() => {});
        if (this.address) URL.revokeObjectURL(this.address);
        const next = this.root.nextElementSibling?.querySelector("button:last-of-type") || document.getElementById("files");
        this.root.remove();
        next.focus();
        say(`${this.title} is removed`);
    }
}
