// SPDX-License-Identifier: MIT
// The object in a photograph, as the server finds it: for the mask's editor.
import { follow, remove, submit } from "./api.js";

async function picture_of(job, name) {
    const file = job.files.find((one) => one.name === name);
    const answer = await fetch(file.url);
    return createImageBitmap(await answer.blob());
}

// told is given words for what is waited for.
export async function find_object(file, told) {
    const job = await follow(await submit("mask", [["photo", file]], null), (now) => {
        told(now.state === "queued" && now.position ? `Waiting: ${now.position} before it` : "Finding the object");
    });
    if (job.state !== "done") throw new Error(job.error || "The search for the object was cancelled.");
    const found = { photo: await picture_of(job, "photo.png"), mask: await picture_of(job, "mask.png") };
    remove(job).catch(() => {});
    return found;
}
