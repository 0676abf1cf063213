// What says how the picture lies: the axes of the world, a bar of a known length, and the part of the screen that nothing covers.

const AXES = [["x", "#d1495b"], ["y", "#4f9d69"], ["z", "#3b7dd8"]];

// Three arrows in a corner, turned as the world is.
function makeAxes(svg) {
  const reach = 26, middle = 36;
  svg.setAttribute("viewBox", "0 0 72 72");
  const make = (name, attributes, parent) => {
    const node = document.createElementNS("http://www.w3.org/2000/svg", name);
    for (const [key, value] of Object.entries(attributes)) node.setAttribute(key, value);
    parent.append(node);
    return node;
  };
  const arrows = AXES.map(([letter, color]) => {
    const group = make("g", {}, svg);
    const line = make("line", { x1: middle, y1: middle, stroke: color, "stroke-width": 2, "stroke-linecap": "round" }, group);
    const text = make("text", { fill: color, "text-anchor": "middle", "dominant-baseline": "central", "font-size": 13, "font-weight": 600 }, group);
    text.textContent = letter;
    return { group, line, text };
  });
  const direction = new THREE.Vector3(), turn = new THREE.Quaternion();
  return (camera) => {
    turn.copy(camera.quaternion).invert();
    const seen = arrows.map((arrow, k) => {
      direction.set(Number(k === 0), Number(k === 1), Number(k === 2)).applyQuaternion(turn);
      const at = (length) => [middle + direction.x * length, middle - direction.y * length];
      [[arrow.line, "x2", "y2", at(reach - 8)], [arrow.text, "x", "y", at(reach)]].forEach(([node, x, y, [px, py]]) => {
        node.setAttribute(x, px.toFixed(2));
        node.setAttribute(y, py.toFixed(2));
      });
      return { arrow, depth: direction.z };
    });
    // What points at the viewer is in front.
    for (const { arrow } of seen.sort((a, b) => a.depth - b.depth)) svg.append(arrow.group);
  };
}

// A length that reads well and is at most `most`: 1, 2 or 5 times a power of ten.
function roundLength(most) {
  const power = Math.pow(10, Math.floor(Math.log10(most)));
  return [5, 2, 1].map((k) => k * power).find((length) => length <= most) || power;
}

// The bar: as long as a round length at the point that the camera looks at.
function showScale(camera, target, bar, text) {
  const high = 2 * camera.position.distanceTo(target) * Math.tan(camera.fov * Math.PI / 360);
  const pixel = high / window.innerHeight, length = roundLength(140 * pixel);
  bar.style.width = length / pixel + "px";
  text.textContent = Number(length.toPrecision(1)).toString();
}

// What nothing covers, in pixels. On a narrow screen the panel is above and the buttons are below, else they are at the sides.
function freeArea(narrow) {
  const box = (id) => document.getElementById(id).getBoundingClientRect();
  const [panel, tools, bar] = ["panel", "tools", "bar"].map(box);
  return narrow ? { left: 0, right: window.innerWidth, top: panel.bottom, bottom: tools.top }
    : { left: panel.height > 0.3 * window.innerHeight ? panel.right : 0, right: tools.left, top: 0, bottom: bar.top };
}
