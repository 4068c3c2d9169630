// SPDX-License-Identifier: MIT
// The worker's calls as promises.

export class Estimator {
    calls = new Map();
    last = 0;

    constructor() {
        // A worker of a blob has the page's content policy, by which it cannot reach another host; one of a file has none.
        const program = new Blob([`import ${JSON.stringify(new URL("./worker.js", import.meta.url).href)};`], { type: "text/javascript" });
        this.worker = new Worker(URL.createObjectURL(program), { type: "module" });
        this.worker.onmessage = ({ data: { id, told, result, error } }) => {
            const call = this.calls.get(id);
            if (told) return call?.told?.(told);
            this.calls.delete(id);
            if (error) call?.failed(new Error(error));
            else call?.done(result);
        };
        this.worker.onerror = (e) => {
            e.preventDefault();
            const error = new Error(e.message ? `The page’s program failed: ${e.message}` : "The page’s program cannot be loaded: is its server still there?");
            for (const call of this.calls.values()) call.failed(error);
            this.calls.clear();
        };
    }

    // told is given what the worker tells before it answers.
    call(name, given = [], told = null) {
        const id = ++this.last;
        return new Promise((done, failed) => {
            this.calls.set(id, { done, failed, told });
            this.worker.postMessage({ id, name, given });
        });
    }
}
