// SPDX-License-Identifier: MIT
// A job as it is seen: a picture, how far it is, and what came of it.
import { follow, remove, submit } from "./api.js";
import { bytes, make, say } from "./parts.js";

const stages = {
    reading: "Reading", "finding the object": "Finding the object", estimating: "Estimating", refining: "Refining normals",
    solving: "Solving", integrating: "Integrating", relighting: "Lighting", writing: "Writing files",
};
const first = ["viewer.html", "overview.png", "maps.exr", "mesh.glb"];

function files_of(job) {
    const sorted = [...job.files].sort((a, b) => (first.indexOf(a.name) + 9) % 9 - (first.indexOf(b.name) + 9) % 9);
    return sorted.map((file) => make("li", {}, make("a", { href: file.url, download: file.name }, file.name), " ",
        make("span", { class: "dim" }, bytes(file.bytes))));
}

function words_of(now) {
    if (now.state === "queued") return now.position ? `Waiting: ${now.position} before it` : "Waiting";
    return stages[now.stage] || "Working";
}

export class Card {
    // title: what is shown of it; picture: a URL, or null.
    constructor(list, title, picture) {
        this.title = title;
        this.bar = make("progress", { max: 1, value: 0, "aria-label": `Progress of ${title}` });
        this.words = make("p", { class: "dim" }, "Sending");
        this.body = make("div", { class: "body" });
        this.button = make("button", { type: "button", "aria-label": `Cancel ${title}`, onclick: () => this.leave() }, "Cancel");
        this.root = make("li", { class: "card" },
            make("div", { class: "head" }, picture ? make("img", { src: picture, alt: "", onerror: (e) => e.target.remove() }) : null,
                make("div", { class: "what" }, make("h3", {}, title), this.words, this.bar), this.button), this.body);
        this.gone = false;
        list.prepend(this.root);
    }

    // Sends fields and follows the job; gives it back when it is done, else null.
    async run(kind, fields) {
        try {
            this.job = await submit(kind, fields, (share) => { this.bar.value = 0.1 * share; });
            if (this.gone) return remove(this.job).then(() => null, () => null);
            const now = await follow(this.job, (told) => {
                this.words.textContent = words_of(told);
                this.bar.value = 0.1 + 0.9 * told.progress;
            });
            if (this.gone || now.state === "cancelled") return null;
            if (now.state === "failed") throw new Error(now.error);
            this.job = now;
            this.done();
            return now;
        } catch (error) {
            if (!this.gone) this.fail(error.message);
            return null;
        }
    }

    fail(words) {
        this.words.textContent = words;
        this.words.className = "wrong";
        this.bar.hidden = true;
        this.button.textContent = "Remove";
        this.button.setAttribute("aria-label", `Remove ${this.title}`);
        say(`${this.title}: ${words}`);
    }

    done() {
        const job = this.job, view = job.files.find((file) => file.name === "viewer.html");
        this.bar.hidden = true;
        this.button.textContent = "Remove";
        this.button.setAttribute("aria-label", `Remove ${this.title} from the server`);
        this.words.textContent = (job.report?.model ? `By ${job.report.model}` : "Done") + `, ${(job.ended - job.created) || "under 1"} s`;
        for (const warning of job.report?.warnings || []) this.body.append(make("p", { class: "warning" }, warning.message));
        if (view)
            this.body.append(make("iframe", { src: view.url, title: `Viewer of ${this.title}`, loading: "lazy", allowfullscreen: true }),
                make("p", {}, make("a", { href: view.url, target: "_blank", rel: "noopener" }, "Open the viewer by itself")));
        this.body.append(make("details", {}, make("summary", {}, `Files (${job.files.length})`), make("ul", { class: "files" }, ...files_of(job))));
        say(`${this.title} is done`);
    }

    leave() {
        this.gone = true;
        if (this.job) remove(this.job).catch(() => {});
        this.root.remove();
        say(`${this.title} was removed`);
    }
}
