// node onnxruntime.mjs FOLDER THREADS: runs what write_onnx wrote by ONNX Runtime. Prints milliseconds of the best and the
// median of 20 runs, and by how much of its own largest value the output that differs most does so.
import { readFileSync } from 'node:fs';
import { createRequire } from 'node:module';

const require = createRequire(process.cwd() + '/');
const ort = require('onnxruntime-node');
const [folder, threads] = process.argv.slice(2);
const read = (name) => {
    const bytes = readFileSync(`${folder}/${name}`);
    return new Float32Array(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length));
};

const feeds = {}, truth = {};
for (const line of readFileSync(`${folder}/tensors.txt`, 'utf8').trim().split('\n')) {
    const [kind, name, ...shape] = line.split(' ');
    if (kind === 'in') feeds[name] = new ort.Tensor('float32', read(`${name}.in`), shape.map(Number));
    else truth[name] = read(`${name}.out`);
}
const session = await ort.InferenceSession.create(`${folder}/network.onnx`, {
    intraOpNumThreads: Number(threads), interOpNumThreads: 1, graphOptimizationLevel: 'all', executionMode: 'sequential',
});
let results = await session.run(feeds);
let most = 0;
for (const [name, expected] of Object.entries(truth)) {
    const got = results[name].data;
    let largest = 0, apart = 0;
    for (let i = 0; i < expected.length; i++) {
        largest = Math.max(largest, Math.abs(expected[i]));
        apart = Math.max(apart, Math.abs(expected[i] - got[i]));
    }
    most = Math.max(most, apart / largest);
}
const ms = [];
for (let i = 0; i < 20; i++) {
    const began = performance.now();
    results = await session.run(feeds);
    ms.push(performance.now() - began);
}
ms.sort((a, b) => a - b);
console.log(`${ms[0].toFixed(1)} ${ms[10].toFixed(1)} ${most.toExponential(1)}`);
