// The page: camera, buttons, keys, and the loop that draws.

function fill(data, bodies) {
  const element = (id) => document.getElementById(id);
  for (const id of ["facts", "legend"]) element(id).replaceChildren();
  element("headline").textContent = data.headline;
  for (const [label, value] of data.facts) {
    const dt = document.createElement("dt"), dd = document.createElement("dd");
    dt.textContent = label;
    dd.textContent = value;
    element("facts").append(dt, dd);
  }
  element("notes").textContent = data.notes.join("\n");
  for (const body of bodies.slice(0, 40)) {
    const row = document.createElement("li"), swatch = document.createElement("span");
    swatch.className = "swatch";
    swatch.style.background = "#" + body.color.getHexString();
    row.append(swatch, document.createTextNode(body.name));
    element("legend").append(row);
  }
  if (bodies.length > 40) {
    const row = document.createElement("li");
    row.textContent = "and " + (bodies.length - 40) + " more";
    element("legend").append(row);
  }
}

// Shows data of the form that `d2m view` writes. What it answers can show other data in the same page.
function start(data) {
  const element = (id) => document.getElementById(id);
  const renderer = new THREE.WebGLRenderer({ antialias: true, preserveDrawingBuffer: true });
  renderer.localClippingEnabled = true;
  element("stage").append(renderer.domElement);
  const scene = new THREE.Scene();
  scene.add(new THREE.HemisphereLight(0xffffff, 0x8890a0, 1.6));
  const light = new THREE.DirectionalLight(0xffffff, 1.8);
  light.position.set(1, 2, 3);
  const camera = new THREE.PerspectiveCamera(40, 1, 0.1, 100);
  const zUp = data.up === "z";
  if (zUp) camera.up.set(0, 0, 1);
  camera.add(light);
  scene.add(camera);

  let shown, groups, bodies, moveTo, paths, marks, t0, t1, moments;
  // Puts the bodies of the data in the place of those that were shown.
  function put(next) {
    if (shown) { scene.remove(shown); discard(shown); }
    data = next;
    shown = new THREE.Group();
    scene.add(shown);
    ({ groups, bodies, moveTo } = makeBodies(data, shown));
    paths = makePaths(bodies, data.window, shown);
    marks = makeMarks(data, bodies, shown);
    [t0, t1] = data.window;
    moments = [...new Set(data.marks.map((mark) => mark.from))].sort((a, b) => a - b);
    fill(data, bodies);
    makeStrip(data, element("strip"));
    makeCurve(data, element("curve"));
    makeTicks(moments, data, element("ticks"), jump);
    for (const id of ["contact", "near"]) element(id).hidden = moments.length === 0;
  }
  let time = 0, playing = false, last = 0, dirty = true, held = [];
  put(data);
  const narrow = () => window.matchMedia("(max-width: 640px)").matches;
  if (narrow() && !data.panel_stays) element("panel").open = false;

  const whole = new THREE.Box3(), center = new THREE.Vector3(), corner = new THREE.Vector3();
  for (const body of bodies) {
    for (let k = 0; k <= 32; k++) {
      place(body, t0 + (t1 - t0) * k / 32, body.position, body.rotation);
      whole.expandByPoint(corner.copy(body.position).addScalar(body.group.radius));
      whole.expandByPoint(corner.copy(body.position).addScalar(-body.group.radius));
    }
  }
  whole.getCenter(center);
  const size = Math.max(whole.max.distanceTo(whole.min) / 2, 1e-30);
  const showAxes = makeAxes(element("axes"));
  const controls = new THREE.OrbitControls(camera, renderer.domElement);
  // A single contact is what one wants to see from near.
  if (data.marks.length === 1) center.fromArray(data.marks[0].points[0]);
  controls.target.copy(center);
  corner.set(0.6, zUp ? -1 : 0.5, zUp ? 0.5 : 1).normalize();
  // So far away that the part of the screen that is free has room for what is seen.
  const area = freeArea(narrow()), least = Math.min(area.right - area.left, area.bottom - area.top);
  camera.position.copy(center).addScaledVector(corner, size * Math.min(Math.max(1.5 * window.innerHeight / Math.max(least, 1), 2), 4));
  camera.near = size * 1e-3;
  camera.far = size * 100;

  const cut = new THREE.Plane();
  function show(t) {
    time = Math.min(Math.max(t, t0), t1);
    element("time").value = String(percent(data, time) * 100);
    moveTo(time);
    held = marks.moveTo(time);
    const span = spanAt(data, time);
    element("now").textContent = "t = " + time.toPrecision(9);
    element("holds").textContent = span.text + (span.status === "clear" ? distanceText(data, time) : "");
    element("holds").className = span.status;
    dirty = true;
  }
  function jump(t) { pause(); show(t); }
  function pause() { playing = false; element("play").textContent = "▶"; }
  function play() { playing = !playing; element("play").textContent = playing ? "❚❚" : "▶"; last = performance.now(); }
  function next() {
    const later = moments.find((moment) => moment > time);
    if (moments.length) jump(later === undefined ? moments[0] : later);
  }
  // Comes near the contact that is held, or goes back to where everything is seen.
  let far = null;
  function near() {
    if (!held.length && moments.length) next();
    if (far) {
      [camera.position, controls.target].forEach((vector, k) => vector.copy(far[k]));
      far = null;
    } else if (held.length) {
      far = [camera.position.clone(), controls.target.clone()];
      const reach = nearness(held[0], size);
      corner.subVectors(camera.position, controls.target).normalize();
      controls.target.fromArray(held[0].points[0]);
      camera.position.copy(controls.target).addScaledVector(corner, reach);
    }
    camera.near = Math.min(size * 1e-3, camera.position.distanceTo(controls.target) * 1e-2);
    camera.updateProjectionMatrix();
    element("near").setAttribute("aria-pressed", String(far !== null));
    dirty = true;
  }
  function aim() {
    // The cut goes through the contact (or the middle of what is seen), across the way one looks.
    const mark = held[0] || data.marks[0];
    const through = mark ? corner.fromArray(mark.points[0]) : corner.copy(controls.target);
    const towards = new THREE.Vector3().subVectors(through, camera.position).normalize();
    cut.setFromNormalAndCoplanarPoint(towards, through);
  }
  const pressed = (id) => element(id).getAttribute("aria-pressed") === "true";
  function look() {
    for (const { material } of groups) {
      material.clippingPlanes = pressed("cut") ? [cut] : [];
      material.transparent = pressed("ghost");
      material.opacity = pressed("ghost") ? 0.3 : 1;
      material.depthWrite = !pressed("ghost");
      material.wireframe = pressed("wire");
      material.needsUpdate = true;
    }
    paths.visible = pressed("paths");
    dirty = true;
  }
  function toggle(id) { element(id).setAttribute("aria-pressed", String(!pressed(id))); look(); }
  function paint() {
    const dark = document.documentElement.classList.contains("dark");
    scene.background = new THREE.Color(dark ? 0x14181f : 0xf4f5f7);
    dirty = true;
  }
  function theme() { document.documentElement.classList.toggle("dark"); paint(); }
  function resize() {
    renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
    renderer.setSize(window.innerWidth, window.innerHeight);
    camera.aspect = window.innerWidth / window.innerHeight;
    // What is below the bar and the buttons takes its place from them.
    document.documentElement.style.setProperty("--bar", element("bar").offsetHeight + "px");
    document.documentElement.style.setProperty("--tools", element("tools").offsetHeight + "px");
    const free = freeArea(narrow());
    const aside = [window.innerWidth - free.left - free.right, window.innerHeight - free.top - free.bottom].map((sum) => sum / 2);
    camera.setViewOffset(window.innerWidth, window.innerHeight, ...aside, window.innerWidth, window.innerHeight);
    camera.updateProjectionMatrix();
    dirty = true;
  }
  // Where a point of the world is on the screen, in pixels.
  function onScreen(point) {
    camera.updateMatrixWorld();
    corner.fromArray(point).project(camera);
    return [(corner.x + 1) / 2 * window.innerWidth, (1 - corner.y) / 2 * window.innerHeight];
  }
  function frame(now) {
    if (playing) {
      // The whole window in eight seconds; a simulation in its own time.
      const rate = data.real_time ? 1 : (t1 - t0) / 8;
      const later = time + (now - last) / 1000 * rate;
      show(later > t1 ? t0 : later);
    }
    last = now;
    if (controls.update()) dirty = true;
    if (dirty) {
      dirty = false;
      if (pressed("cut")) aim();
      marks.update(camera);
      showScale(camera, controls.target, element("scale-bar"), element("scale-text"));
      showAxes(camera);
      renderer.render(scene, camera);
    }
    requestAnimationFrame(frame);
  }

  element("play").onclick = play;
  element("time").oninput = () => jump(t0 + (t1 - t0) * element("time").value / 10000);
  for (const id of ["cut", "ghost", "paths", "wire"]) element(id).onclick = () => toggle(id);
  element("theme").onclick = theme;
  element("contact").onclick = next;
  element("near").onclick = near;
  window.onresize = resize;
  // The panel opens and closes, and another answer has another curve.
  const watch = new ResizeObserver(resize);
  for (const id of ["panel", "tools", "bar"]) watch.observe(element(id));
  window.onkeydown = (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    // What is being filled in keeps its keys.
    if (event.target.matches && event.target.matches("select, input:not(#time)")) return;
    const step = (t1 - t0) * (event.shiftKey ? 0.001 : 0.01);
    const keys = {
      " ": play, c: next, n: near, x: () => toggle("cut"), g: () => toggle("ghost"), t: () => toggle("paths"), w: () => toggle("wire"),
      d: theme, ArrowRight: () => jump(time + step), ArrowLeft: () => jump(time - step), Home: () => jump(t0), End: () => jump(t1),
    };
    const action = keys[event.key.length === 1 ? event.key.toLowerCase() : event.key];
    if (action) { event.preventDefault(); action(); }
  };
  if (window.matchMedia("(prefers-color-scheme: dark)").matches) document.documentElement.classList.add("dark");
  const asked = new URLSearchParams(location.hash.slice(1));
  if (asked.get("theme")) document.documentElement.classList.toggle("dark", asked.get("theme") === "dark");
  for (const id of ["cut", "ghost", "paths", "wire"]) if (asked.has(id)) element(id).setAttribute("aria-pressed", "true");
  paint();
  resize();
  look();
  const at = parseFloat(asked.get("t"));
  show(Number.isFinite(at) ? at : data.marks.length === 1 ? data.marks[0].from : t0);
  requestAnimationFrame(frame);
  return {
    show,
    // The time of the first mark, if there is one, else the one that was shown.
    load(next) {
      put(next);
      look();
      if (!playing) show(data.marks.length === 1 ? data.marks[0].from : time);
    },
    // What a test of the page reads.
    state: () => ({ time, holds: element("holds").textContent, span: spanAt(data, time).status,
      bodies: bodies.map((body) => body.position.toArray()), marks: held.length, mark: held.length ? onScreen(held[0].points[0]) : null }),
  };
}

// Gives back what the graphics card holds.
function discard(all) {
  all.traverse((part) => {
    if (part.geometry) part.geometry.dispose();
    if (part.material) part.material.dispose();
    if (part.isInstancedMesh) part.dispose();
  });
}

const written = JSON.parse(document.getElementById("data").textContent);
if (written) {
  try {
    window.d2m = start(written);
  } catch (error) {
    document.getElementById("notes").textContent += "\nThis page needs WebGL: " + error;
    throw error;
  }
}
