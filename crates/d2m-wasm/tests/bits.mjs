// Holds the engine in WebAssembly against the native command, number by number and bit by bit:
//     node bits.mjs PKG D2M [QUERIES]
// PKG: the folder that `wasm-bindgen --target web` wrote; D2M: the command.
import { spawnSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { pathToFileURL } from "node:url";
import assert from "node:assert/strict";

const [pkg, command, queries = "240"] = process.argv.slice(2);
const engine = await import(pathToFileURL(resolve(pkg, "d2m_wasm.js")));
engine.initSync({ module: readFileSync(join(pkg, "d2m_wasm_bg.wasm")) });
const { Mesh } = engine;
const folder = mkdtempSync(join(tmpdir(), "d2m-wasm-"));

// xorshift32: the same trials every time.
let state = 0x9e3779b9;
function random(low, high) {
  state ^= state << 13; state ^= state >>> 17; state ^= state << 5;
  return low + (high - low) * (state >>> 0) / 4294967296;
}
const pick = (list) => list[Math.floor(random(0, list.length))];
const vector = (size) => [0, 1, 2].map(() => random(-size, size));
const turn = () => [random(-1, 1), ...vector(1)];

const SHAPES = ["box", "tetrahedron", "box?x=1&y=0.2&z=0.4", "icosphere?triangles=320", "gear?triangles=600", "torus?triangles=800",
  "torus-knot?triangles=1200", "chain-link?triangles=500", "paddle-wheel?triangles=400", "pebble?triangles=1280&seed=7", "screw", "nut"];

// One motion of each form of the formats. A begins some lengths away and comes near; B is about the origin.
const start = () => vector(1).map((x) => x + (x < 0 ? -2 : 2));
const towards = (x) => x.map((c) => -c * random(0.5, 2.5));
const MOTIONS = {
  twist: () => { const x = start(); return { x, q: turn(), v: towards(x), w: vector(8) }; },
  "twist about a point": () => { const x = start(); return { x, q: turn(), v: towards(x), w: vector(3), at: vector(0.5), t: random(0, 1) }; },
  "fast spin": () => { const x = start(); return { x, v: towards(x), w: vector(300) }; },
  keyframes: () => {
    const x = start(), end = x.map((c, i) => c + towards(x)[i]);
    return { times: [0, random(0.2, 0.8), 1], poses: [{ x, q: turn() }, { x: vector(1.5), q: turn() }, { x: end, q: turn() }],
      join: pick(["linear", "screw", "cubic", "quintic"]) };
  },
  "arm of polynomials": () => {
    // Cubic pieces that meet with their slopes, and a turn of degree five.
    const along = () => {
      const [a, b, c, d] = [random(1.5, 3), random(-6, 0), random(-2, 2), random(-3, 3)];
      const s = 0.5, value = a + s * (b + s * (c + s * d)), slope = b + s * (2 * c + s * 3 * d);
      return { times: [0, s, 1], pieces: [[a, b, c, d], [value, slope, random(-2, 2), random(-2, 2)]] };
    };
    const joint = (axis) => ({ joint: "prismatic", axis, value: along() });
    return { chain: [joint([1, 0, 0]), { joint: "fixed", x: vector(0.5), q: turn() }, joint([0, 1, 0]),
      { joint: "revolute", axis: vector(1), value: [0, ...vector(2), ...vector(2)] }] };
  },
};
const B_MOTIONS = [() => ({}), () => ({ x: vector(0.5), q: turn(), w: vector(4) }), () => ({ x: vector(0.3), v: vector(1) })];

// The command's answer, or the line that states what is wrong.
function native(words) {
  const { status, stdout, stderr } = spawnSync(command, [...words, "--json"], { encoding: "utf8" });
  assert.ok(status === 0 || status === 3, `${status}: ${stderr}`);
  return status === 0 ? { answer: JSON.parse(stdout) } : { fault: stderr.trim().split("\n").at(-1) };
}

// Every number, word and list of the command's answer, with its bits; how long it took differs.
let numbers = 0;
function same(ours, theirs, place) {
  if (typeof theirs === "number") {
    numbers++;
    assert.ok(Object.is(ours, theirs), `${place}: ${ours} here, ${theirs} natively`);
  } else if (theirs !== null && typeof theirs === "object") {
    assert.equal(ours?.length, theirs.length, place);
    for (const key of Object.keys(theirs)) if (key !== "microseconds") same(ours[key], theirs[key], `${place}.${key}`);
  } else assert.equal(ours, theirs, place);
}

const made = new Map();
const meshOf = (shape) => { if (!made.has(shape)) made.set(shape, Mesh.shape(shape)); return made.get(shape); };
const file = (name, text) => { const path = join(folder, name); writeFileSync(path, text); return path; };
const moved = (a, b) => ["--motion-a", "@" + file("a.json", JSON.stringify(a)), "--motion-b", "@" + file("b.json", JSON.stringify(b))];

const counts = {};
for (let k = 0; k < Number(queries); k++) {
  const [kind, make] = pick(Object.entries(MOTIONS)), shapes = [pick(SHAPES), pick(SHAPES)];
  const motions = [make(), pick(B_MOTIONS)()], [a, b] = shapes.map(meshOf);
  const named = shapes.map((shape) => "shape:" + shape), question = k % 5 === 4 ? "clearance" : k % 10 === 3 ? "distance" : k % 20 === 7 ? "spans" : "toc";
  const place = `query ${k}, ${question} of ${shapes.join(" and ")}, ${kind}`;
  let ours, theirs;
  if (question === "toc") {
    const options = pick([{}, { clearance: true }, { min_separation: 0.05 }, { solid: false }, { tolerance: 1e-6 }, { start: "leave" }]);
    const words = { clearance: ["--clearance"], min_separation: ["--min-separation", "0.05"], solid: ["--surface"],
      tolerance: ["--tolerance", "1e-6"], start: ["--start", "leave"] }[Object.keys(options)[0]] ?? [];
    theirs = native(["toc", ...named, ...moved(...motions), ...words]);
    ours = engine.timeOfContact(a, motions[0], b, motions[1], options);
  } else if (question === "spans") {
    theirs = native(["spans", ...named, ...moved(...motions), "--resolution", "0.001"]);
    ours = engine.contactSpans(a, motions[0], b, motions[1], { resolution: 0.001 });
  } else if (question === "clearance") {
    theirs = native(["clearance", ...named, ...moved(...motions)]);
    ours = engine.clearance(a, motions[0], b, motions[1]);
  } else {
    const poses = [{ x: start(), q: turn() }, { q: turn(), at: vector(0.2) }];
    const text = poses.map((pose, i) => "@" + file(`pose${i}.json`, JSON.stringify(pose)));
    theirs = native(["distance", ...named, "--pose-a", text[0], "--pose-b", text[1]]);
    ours = engine.distance(a, poses[0], b, poses[1]);
  }
  assert.ok(theirs.answer, `${place}: ${theirs.fault}`);
  same(ours, theirs.answer, place);
  const what = `${question} ${ours.status ?? "told"}`;
  counts[what] = (counts[what] ?? 0) + 1;
}
for (const what of ["toc contact", "toc separated", "clearance clear", "distance separated", "spans told"]) assert.ok(counts[what] > Number(queries) / 100, `${what}: ${counts[what]} of ${queries} queries`);

// A shape, its arrays and a file of it are the same mesh.
{
  const gear = meshOf("gear?triangles=600"), positions = gear.positions(), triangles = gear.triangles();
  const lines = [];
  for (let i = 0; i < positions.length; i += 3) lines.push("v " + positions.slice(i, i + 3).join(" "));
  for (let i = 0; i < triangles.length; i += 3) lines.push("f " + Array.from(triangles.slice(i, i + 3), (v) => v + 1).join(" "));
  const obj = lines.join("\n") + "\n", motion = { x: [-2.2, 0.3, 0.1], v: [4, 0, 0], w: [1, 2, 3] };
  const theirs = native(["toc", file("gear.obj", obj), "shape:torus", ...moved(motion, {})]).answer;
  for (const mesh of [gear, new Mesh(positions, triangles), Mesh.parse(new TextEncoder().encode(obj), "gear.obj")]) {
    same(engine.timeOfContact(mesh, motion, meshOf("torus"), {}), theirs, "a gear from arrays and from a file");
  }
  assert.equal(gear.triangleCount, triangles.length / 3);
  assert.ok(gear.isWatertight && !new Mesh([0, 0, 0, 1, 0, 0, 0, 1, 0], [0, 1, 2]).isWatertight);
}

// Bad motions: an exception whose text is the command's, but for the name of the file.
const box = meshOf("box");
for (const motion of [{ x: [1, 2] }, { y: 1 }, { q: [0, 0, 0, 0] }, { v: [1e300, 0, 0] }, { w: [1e300, 0, 0] }, { times: [0, 0.5], poses: [{}, {}] },
  { times: [0, 0], poses: [{}, {}] }, { times: [0, 1], poses: [{ q: [1, 0, 0, 0] }, { q: [0, 1, 0, 0] }] }, { chain: [{ joint: "screw" }] },
  { chain: [{ joint: "revolute", axis: [0, 0, 0], value: [0] }] }, { times: [0, 1], poses: [{}, {}], join: "bent" }]) {
  const theirs = native(["toc", "shape:box", "shape:box", ...moved(motion, {})]);
  assert.ok(theirs.fault, `${JSON.stringify(motion)} is refused`);
  assert.throws(() => engine.timeOfContact(box, motion, box, {}), (error) => {
    assert.ok(error instanceof Error && !(error instanceof WebAssembly.RuntimeError), String(error));
    const reason = error.message.replace("motion of A: ", "");
    assert.ok(theirs.fault.includes(reason), `${error.message}\n${theirs.fault}`);
    return true;
  });
}
// Other bad input: an exception that names place and value, never the end of the program.
const refused = [
  [() => new Mesh([0, 0], [0, 1, 2]), /positions: the length 2/], [() => new Mesh([], []), /triangles/],
  [() => new Mesh([0, 0, 0, 1, 0, 0, 0, 1, NaN], [0, 1, 2]), /NaN/], [() => new Mesh([0, 0, 0, 1, 0, 0, 0, 1, 0], [0, 1, 3]), /3/],
  [() => Mesh.shape("cube"), /cube/], [() => Mesh.shape("gear?teeth=-1"), /teeth/], [() => Mesh.shape("icosphere?triangles=20000000"), /memory/],
  [() => Mesh.parse(new Uint8Array([1, 2, 3]), "a.xyz"), /a\.xyz/], [() => Mesh.parse(new TextEncoder().encode("f 1 2 9"), "a.obj"), /a\.obj, line 1/],
  [() => Mesh.parse(new Uint8Array(200), "a.stl"), /a\.stl/], [() => Mesh.parse(new Uint8Array(50), "a.3mf"), /a\.3mf/],
  ...[{ window: [1, 0] }, { window: [0, 0] }, { tolerance: 0 }, { tolerance: null, budget: -1 }, { min_separation: -1 }, { speed: 1 }, { accuracy: 1 }, { start: "go" }, { resolution: 1 },
    7, "x", [1], () => 1].map((options) => [() => engine.timeOfContact(box, {}, box, {}, options), /./]),
  [() => engine.timeOfContact(box, () => 1, box, {}), /motion of A/], [() => engine.timeOfContact(box, { x: [NaN, 0, 0] }, box, {}), /motion of A/],
  [() => engine.timeOfContact(box, "x=1,2", box, {}), /motion of A/], [() => engine.timeOfContact(box, 5, box, {}), /motion of A/],
  [() => engine.distance(box, { v: [1, 0, 0] }, box, {}), /pose of A: v/], [() => engine.distance(box, {}, box, {}, { window: [0, 1] }), /window/],
  [() => engine.timeOfContact(null, {}, box, {}), /./], [() => engine.timeOfContact({}, {}, box, {}), /./],
  [() => engine.timeOfContact(new Mesh([0, 0, 0, 1, 0, 0, 0, 1, 0], [0, 1, 2]), {}, box, {}, { solid: true }), /watertight/],
];
for (const [call, words] of refused) {
  assert.throws(call, (error) => {
    assert.ok(error instanceof Error && !(error instanceof WebAssembly.RuntimeError), `${call}: ${error}`);
    assert.match(error.message, words, String(call));
    return true;
  });
}
const few = engine.timeOfContact(meshOf("screw"), {}, meshOf("nut"), { v: [0, 0, 1], w: [0, 0, 0.1] }, { budget: 1 });
assert.ok(few.status !== "separated" && engine.shapes().length > 8 && few.spans.at(-1).to === 1);

rmSync(folder, { recursive: true });
console.log(`${queries} queries: ${numbers} numbers have the bits of the native command; ${JSON.stringify(counts)}`);
