// Contacts: the pair of triangles, the points on both bodies, and the normal, drawn over everything else.

const MARK_COLOR = 0xe0195a;
// The triangles of A and of B: neither a color of bodies nor of the other.
const PAIR_COLORS = [0xffd23f, 0x35e0d0];

function overlay(color, opacity) {
  return new THREE.MeshBasicMaterial({
    color, depthTest: false, transparent: true, opacity, side: THREE.DoubleSide,
  });
}

function makeMark(mark, bodies) {
  const all = new THREE.Group();
  const points = mark.points.map((point) => {
    const dot = new THREE.Mesh(new THREE.SphereGeometry(0.007, 20, 14), overlay(MARK_COLOR, 1));
    dot.position.fromArray(point);
    all.add(dot);
    return dot;
  });
  const normal = new THREE.Vector3().fromArray(mark.normal);
  let arrow = null;
  if (normal.length() > 0) {
    arrow = new THREE.ArrowHelper(normal.normalize(), points[0].position, 0.11, MARK_COLOR, 0.028, 0.016);
    for (const part of [arrow.line, arrow.cone]) { part.material.depthTest = false; part.material.transparent = true; }
    all.add(arrow);
  }
  const faces = (mark.triangles || []).map((corners, k) => {
    const body = bodies[mark.bodies[k]];
    const geometry = new THREE.BufferGeometry();
    const centered = corners.flatMap((p) => p.map((c, i) => c - body.center[i]));
    geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(centered), 3));
    const face = new THREE.Mesh(geometry, overlay(PAIR_COLORS[k], 0.55));
    const ring = new THREE.BufferGeometry();
    ring.setAttribute("position", new THREE.BufferAttribute(new Float32Array(centered.concat(centered.slice(0, 3))), 3));
    const edge = new THREE.Line(ring, new THREE.LineBasicMaterial({ color: MARK_COLOR, depthTest: false, transparent: true }));
    for (const part of [face, edge]) { part.matrixAutoUpdate = false; all.add(part); }
    return { parts: [face, edge], body };
  });
  const one = new THREE.Vector3(1, 1, 1);
  all.traverse((child) => { child.renderOrder = 2; });
  return {
    mark, all,
    // Dots and arrow keep their size on the screen; the triangles move with their bodies.
    update(camera, size) {
      for (const dot of points) dot.scale.setScalar(size * camera.position.distanceTo(dot.position));
      if (arrow) arrow.scale.setScalar(size * camera.position.distanceTo(points[0].position));
      for (const { parts, body } of faces) for (const part of parts) part.matrix.compose(body.position, body.rotation, one);
    },
  };
}

// From how far a contact is looked at: a few times its triangles, or a part of all that moves.
function nearness(mark, size) {
  const lengths = (mark.triangles || []).map(([a, b, c]) => Math.max(...[[a, b], [b, c], [c, a]].map(([p, q]) => Math.hypot(...p.map((x, i) => x - q[i])))));
  return Math.min(Math.max(6 * Math.max(0, ...lengths), 0.02 * size), 0.5 * size);
}

// The marks that hold at a time, made when they are first shown. At most 256 at once.
function makeMarks(data, bodies, scene) {
  const made = new Map();
  let shown = [];
  return {
    moveTo(t) {
      for (const each of shown) each.all.visible = false;
      shown = [];
      for (let k = 0; k < data.marks.length && shown.length < 256; k++) {
        const mark = data.marks[k];
        if (!(mark.from <= t && t <= mark.until)) continue;
        if (!made.has(k)) { made.set(k, makeMark(mark, bodies)); scene.add(made.get(k).all); }
        made.get(k).all.visible = true;
        shown.push(made.get(k));
      }
      return shown.map((each) => each.mark);
    },
    // Many at once are smaller.
    update(camera) { for (const each of shown) each.update(camera, shown.length > 3 ? 0.5 : 1); },
  };
}
