// Sliders change the motion of A, and the engine in this page answers: nothing is shown that it did not prove.

const LIVE = {
  shapes: ["gear?triangles=2000", "box?x=0.5&y=0.5&z=0.5", "torus-knot?triangles=2000", "chain-link?triangles=1000", "pebble?triangles=1280",
    "paddle-wheel?triangles=800", "tetrahedron", "icosphere"],
  // Label, what it is the motion's, and which number of it; ends, step and the value at first.
  sliders: [
    { id: "height", label: "height", key: "x", axis: 1, from: -2, to: 2, first: 0.2 },
    { id: "vx", label: "velocity x", key: "v", axis: 0, from: -8, to: 8, first: 4 },
    { id: "vy", label: "velocity y", key: "v", axis: 1, from: -4, to: 4, first: 0 },
    { id: "vz", label: "velocity z", key: "v", axis: 2, from: -4, to: 4, first: 0 },
    { id: "wx", label: "spin x", key: "w", axis: 0, from: -12, to: 12, first: 0 },
    { id: "wy", label: "spin y", key: "w", axis: 1, from: -12, to: 12, first: 0 },
    { id: "wz", label: "spin z", key: "w", axis: 2, from: -12, to: 12, first: 3 },
  ],
  start: [-3, 0, 0],
  window: [0, 1],
};

// A label and a field, in two columns and a third one for the value.
function addField(form, id, text, field) {
  const label = document.createElement("label");
  label.htmlFor = field.id = id;
  label.textContent = text;
  form.append(label, field);
}

function addChoice(form, id, text, first) {
  const field = document.createElement("select");
  for (const shape of LIVE.shapes) field.add(new Option(shape.split("?")[0], shape, false, shape === first));
  addField(form, id, text, field);
}

function addSlider(form, { id, label, from, to, first }) {
  const field = document.createElement("input"), value = document.createElement("output");
  Object.assign(field, { type: "range", min: from, max: to, step: 0.05, value: first });
  addField(form, id, label, field);
  value.htmlFor = id;
  form.append(value);
}

// The motion that the sliders state, in the form of the files of motions. The body point [0, 0, 0] is at x at the time 0.
function statedMotion(form) {
  const motion = { x: [...LIVE.start], v: [0, 0, 0], w: [0, 0, 0] };
  for (const { id, key, axis } of LIVE.sliders) {
    const field = form.elements[id];
    motion[key][axis] = Number(field.value);
    field.nextElementSibling.textContent = Number(field.value).toFixed(2);
  }
  return motion;
}

// A mesh as the page draws it and the engine knows it; each shape once.
const meshes = new Map();
function meshOf(shape) {
  if (meshes.has(shape)) return meshes.get(shape);
  const mesh = wasm_bindgen.Mesh.shape(shape), positions = mesh.positions();
  const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
  positions.forEach((p, i) => { low[i % 3] = Math.min(low[i % 3], p); high[i % 3] = Math.max(high[i % 3], p); });
  const center = low.map((p, i) => (p + high[i]) / 2);
  const shown = { center, vertices: Float32Array.from(positions, (p, i) => p - center[i % 3]), triangles: mesh.triangles() };
  meshes.set(shape, { mesh, positions, shown });
  return meshes.get(shape);
}

// t0, t1, t_ref, at, x, q (w first), v, w: what the motions of the sliders are to the page.
const flight = ({ x, v, w }) => Float64Array.of(...LIVE.window, 0, 0, 0, 0, ...x, 1, 0, 0, 0, ...v, ...w);

function cornersOf({ positions, shown }, triangle) {
  const vertices = [0, 1, 2].map((k) => shown.triangles[3 * triangle + k]);
  return vertices.map((vertex) => Array.from(positions.slice(3 * vertex, 3 * vertex + 3)));
}

// The contact that is marked. A body inside the other one touches nowhere.
function marksOf(answer, a, b) {
  if (answer.status !== "contact" || answer.start === "contained") return [];
  return [{ from: answer.toc, until: answer.toc_hi, points: [answer.point_a, answer.point_b], normal: answer.normal, bodies: [0, 1],
    triangles: [cornersOf(a, answer.triangle_a), cornersOf(b, answer.triangle_b)] }];
}

const duration = (microseconds) => microseconds < 1e3 ? Math.round(microseconds) + " µs" : (microseconds / 1e3).toFixed(1) + " ms";

function live() {
  const element = (id) => document.getElementById(id), form = element("motion");
  addChoice(form, "shape-a", "A", LIVE.shapes[0]);
  addChoice(form, "shape-b", "B", LIVE.shapes[0]);
  for (const slider of LIVE.sliders) addSlider(form, slider);
  form.onsubmit = (event) => event.preventDefault();

  let viewer = null, data = null, last = null, waits = false;
  function ask() {
    waits = false;
    const motions = [statedMotion(form), { x: [0, 0, 0], v: [0, 0, 0], w: [0, 0, 0] }];
    const names = [form.elements["shape-a"].value, form.elements["shape-b"].value];
    try {
      const [a, b] = names.map(meshOf);
      const answer = wasm_bindgen.timeOfContact(a.mesh, motions[0], b.mesh, motions[1], { window: LIVE.window, clearance: true });
      data = {
        headline: answer.headline, facts: answer.facts, notes: [], window: LIVE.window, up: "y", real_time: false, curve: [], panel_stays: true,
        meshes: [a.shown, b.shown], spans: answer.spans, marks: marksOf(answer, a, b),
        bodies: ["A", "B"].map((label, k) => ({ name: label + ": " + names[k].split("?")[0] + " · " +
          answer.triangles[k] + " triangles", mesh: k, flights: flight(motions[k]) })),
      };
      last = { names, motions, answer };
      if (viewer) viewer.load(data); else viewer = start(data);
      element("engine").className = "";
      element("engine").textContent = "first contact searched in this page in " + duration(answer.microseconds);
    } catch (error) {
      element("engine").className = "fault";
      element("engine").textContent = error.message;
      // Nothing stays that was the answer of another motion.
      last = null;
      if (data && viewer) viewer.load({ ...data, headline: "NO ANSWER", facts: [], spans: [], marks: [] });
    }
  }
  // One answer a frame, however fast a slider moves.
  form.oninput = () => { if (!waits) { waits = true; requestAnimationFrame(ask); } };
  ask();
  window.d2m = { ...viewer, last: () => last };
}

async function open_engine() {
  try {
    const binary = atob(document.getElementById("wasm").textContent.trim());
    await wasm_bindgen({ module_or_path: Uint8Array.from(binary, (c) => c.charCodeAt(0)) });
    live();
  } catch (error) {
    document.getElementById("notes").textContent += "\nThis page needs WebAssembly with SIMD and WebGL: " + error;
    throw error;
  }
}
open_engine();
