// SPDX-License-Identifier: MIT
// The HTTP interface as promises. A refusal is an Error with the server's words.

async function asked(path, options) {
    let answer;
    try {
        answer = await fetch(path, options);
    } catch {
        throw new Error("The server does not answer. Is merlin serve still running?");
    }
    if (answer.status === 204) return null;
    const told = await answer.json().catch(() => ({}));
    if (!answer.ok) throw Object.assign(new Error(told.error || `The server answers ${answer.status}.`), { code: told.code });
    return told;
}

export const status = () => asked("/v1/status");
export const look = (job) => asked(job.url);
export const remove = (job) => asked(job.url, { method: "DELETE" });

// kind: "estimate" and so on; fields: pairs of a name and a value or a file. told is given the share that is sent.
export function submit(kind, fields, told) {
    const form = new FormData();
    for (const [name, value] of fields) form.append(name, value);
    return new Promise((done, failed) => {
        const request = new XMLHttpRequest(); // fetch does not tell how much of an upload is sent
        request.open("POST", `/v1/${kind}`);
        request.responseType = "json";
        request.upload.onprogress = (e) => told?.(e.lengthComputable ? e.loaded / e.total : 0);
        request.onload = () => {
            if (request.status === 202) done(request.response);
            else failed(Object.assign(new Error(request.response?.error || `The server answers ${request.status}.`), { code: request.response?.code }));
        };
        request.onerror = () => failed(new Error("The upload was cut off. Is merlin serve still running?"));
        request.send(form);
    });
}

// Waits until a job has ended, and tells how far it is.
export async function follow(job, told) {
    for (let pause = 150; ; pause = Math.min(pause * 1.3, 1000)) {
        const now = await look(job);
        told(now);
        if (now.state !== "queued" && now.state !== "working") return now;
        await new Promise((done) => setTimeout(done, pause));
    }
}
