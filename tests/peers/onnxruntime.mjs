// node onnxruntime.mjs MODEL FOLDER THREADS [RUNS]: runs a network of merlin-lab export by ONNX Runtime on the inputs that
// network_values wrote. Prints milliseconds of the best and the median of RUNS (20) runs, and by how much of its own largest
// value the output that differs most does so. RUNS 0: that alone.
import { readFileSync } from 'node:fs';
import { createRequire } from 'node:module';

const require = createRequire(process.cwd() + '/');
const ort = require('onnxruntime-node');
const [model, folder, threads, runs = '20'] = process.argv.slice(2);
const read = (name) => {
    const bytes = readFileSync(`${folder}/${name}`);
    return new Float32Array(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length));
};

const session = await ort.InferenceSession.create(model, {
    intraOpNumThreads: Number(threads), interOpNumThreads: 1, graphOptimizationLevel: 'all', executionMode: 'sequential',
});
const feeds = {}, truth = {};
for (const line of readFileSync(`${folder}/tensors.txt`, 'utf8').trim().split('\n')) {
    const [kind, name, ...shape] = line.split(' ');
    if (kind === 'in' && session.inputNames.includes(name))
        feeds[name] = new ort.Tensor('float32', read(`${name}.in`), shape.map(Number));
    if (kind === 'out' && session.outputNames.includes(name)) truth[name] = read(`${name}.out`);
}
const missing = session.outputNames.filter((name) => !truth[name]);
if (missing.length) throw new Error(`no values to compare with: ${missing}`);
const results = await session.run(feeds);
let most = 0;
for (const [name, expected] of Object.entries(truth)) {
    const got = results[name].data;
    if (got.length !== expected.length) throw new Error(`${name}: ${got.length} values instead of ${expected.length}`);
    let largest = 0, apart = 0;
    for (let i = 0; i < expected.length; i++) {
        largest = Math.max(largest, Math.abs(expected[i]));
        apart = Math.max(apart, Math.abs(expected[i] - got[i]));
    }
    most = Math.max(most, apart / largest);
}
// What a reader of maps asks for; the relighting decoder's features are computed in any case.
const wanted = session.outputNames.filter((name) => !name.includes('_features'));
const ms = [];
for (let i = 0; i < Number(runs); i++) {
    const began = performance.now();
    await session.run(feeds, wanted);
    ms.push(performance.now() - began);
}
ms.sort((a, b) => a - b);
const times = ms.length ? `${ms[0].toFixed(1)} ${ms[ms.length >> 1].toFixed(1)} ` : '';
console.log(`${times}${most.toExponential(1)}`);
