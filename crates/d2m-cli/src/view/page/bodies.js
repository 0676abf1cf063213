// The bodies: meshes from the page's data, placed at any time of the window.

const COLORS = [0x3b6fb6, 0xd9822b, 0x4f9d69, 0xb0494f, 0x7a5ea8, 0x3f9aa0, 0xa88a3d, 0x6b7686];

// Numbers as `d2m view` writes them; numbers of the page itself are there already.
function decode(base64, type) {
  if (base64 instanceof type) return base64;
  const binary = atob(base64);
  const bytes = new Uint8Array(binary.length);
  for (let i = 0; i < binary.length; i++) bytes[i] = binary.charCodeAt(i);
  return new type(bytes.buffer);
}

// A flight is 19 numbers: t0, t1, t_ref, at, x, q (w first), v, w. At time t the body point `at` is at x + v·(t − t_ref), and
// the body is turned by exp([w]·(t − t_ref))·q.
const FLIGHT = 19;

// The flight that holds t: the last one that does not begin after t.
function flightAt(flights, t) {
  let low = 0, high = flights.length / FLIGHT - 1;
  while (low < high) {
    const middle = (low + high + 1) >> 1;
    if (flights[middle * FLIGHT] <= t) low = middle; else high = middle - 1;
  }
  return low * FLIGHT;
}

const spin = new THREE.Quaternion(), turn = new THREE.Quaternion(), axis = new THREE.Vector3(), arm = new THREE.Vector3();

// Where the middle of a body's mesh is at time t, and how the body is turned.
function place(body, t, position, rotation) {
  const f = body.flights, k = flightAt(f, t);
  const dt = Math.min(Math.max(t, f[k]), f[k + 1]) - f[k + 2];
  axis.set(f[k + 16], f[k + 17], f[k + 18]);
  const speed = axis.length();
  if (speed > 0) spin.setFromAxisAngle(axis.divideScalar(speed), speed * dt); else spin.identity();
  turn.set(f[k + 10], f[k + 11], f[k + 12], f[k + 9]).normalize();
  rotation.copy(spin).multiply(turn);
  arm.set(body.center[0] - f[k + 3], body.center[1] - f[k + 4], body.center[2] - f[k + 5]).applyQuaternion(rotation);
  position.set(f[k + 6] + f[k + 13] * dt, f[k + 7] + f[k + 14] * dt, f[k + 8] + f[k + 15] * dt).add(arm);
}

// Adds the bodies to a scene: one instanced mesh for all bodies that share a mesh.
function makeBodies(data, scene) {
  const groups = data.meshes.map((mesh, number) => {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(decode(mesh.vertices, Float32Array), 3));
    geometry.setIndex(new THREE.BufferAttribute(decode(mesh.triangles, Uint32Array), 1));
    geometry.computeBoundingSphere();
    const material = new THREE.MeshStandardMaterial({
      color: 0xffffff, flatShading: true, side: THREE.DoubleSide, roughness: 0.75, metalness: 0.05,
    });
    const count = data.bodies.filter((body) => body.mesh === number).length;
    const instances = new THREE.InstancedMesh(geometry, material, Math.max(count, 1));
    instances.count = 0;
    instances.frustumCulled = false;
    scene.add(instances);
    return { instances, material, radius: geometry.boundingSphere ? geometry.boundingSphere.radius : 0 };
  });
  const bodies = data.bodies.map((body, index) => {
    const group = groups[body.mesh];
    const slot = group.instances.count++;
    const color = new THREE.Color(COLORS[index % COLORS.length]);
    group.instances.setColorAt(slot, color);
    return {
      name: body.name, flights: decode(body.flights, Float64Array), center: data.meshes[body.mesh].center,
      group, slot, color, position: new THREE.Vector3(), rotation: new THREE.Quaternion(),
    };
  });
  const matrix = new THREE.Matrix4(), one = new THREE.Vector3(1, 1, 1);
  function moveTo(t) {
    for (const body of bodies) {
      place(body, t, body.position, body.rotation);
      body.group.instances.setMatrixAt(body.slot, matrix.compose(body.position, body.rotation, one));
    }
    for (const group of groups) group.instances.instanceMatrix.needsUpdate = true;
  }
  return { groups, bodies, moveTo };
}

// The way of the middle of each body, one line a body.
function makePaths(bodies, [t0, t1], scene) {
  const all = new THREE.Group();
  const position = new THREE.Vector3(), rotation = new THREE.Quaternion();
  for (const body of bodies.slice(0, 200)) {
    const points = [];
    for (let k = 0; k <= 240; k++) {
      place(body, t0 + (t1 - t0) * k / 240, position, rotation);
      points.push(position.x, position.y, position.z);
    }
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(points), 3));
    all.add(new THREE.Line(geometry, new THREE.LineBasicMaterial({ color: body.color })));
  }
  all.visible = false;
  scene.add(all);
  return all;
}
