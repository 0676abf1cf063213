// What is proven at each time: a strip of spans under the slider, the distance above it, and one sentence.

function percent(data, t) {
  const [t0, t1] = data.window;
  return t1 > t0 ? (Math.min(Math.max(t, t0), t1) - t0) / (t1 - t0) * 100 : 0;
}

function makeStrip(data, strip) {
  strip.replaceChildren();
  for (const span of data.spans) {
    const part = document.createElement("span");
    part.className = span.status;
    part.style.left = percent(data, span.from) + "%";
    part.style.width = percent(data, span.to) - percent(data, span.from) + "%";
    part.title = span.text;
    strip.append(part);
  }
}

// The span that holds a time; where two meet, contact before undecided before clear.
function spanAt(data, t) {
  const order = ["contact", "undecided", "unknown", "clear"];
  const found = data.spans.filter((span) => span.from <= t && t <= span.to);
  found.sort((a, b) => order.indexOf(a.status) - order.indexOf(b.status));
  return found[0] || { status: "unknown", text: "nothing is known of this time" };
}

// Enclosures of the distance at single times, as a band.
function makeCurve(data, svg) {
  svg.replaceChildren();
  svg.toggleAttribute("hidden", !data.curve || data.curve.length < 2);
  if (!data.curve || data.curve.length < 2) return;
  svg.setAttribute("viewBox", "0 0 100 100");
  const most = Math.max(...data.curve.map(([, , high]) => high)) || 1;
  const y = (value) => 100 - 96 * value / most;
  const above = data.curve.map(([t, , high]) => percent(data, t) + "," + y(high));
  const below = data.curve.map(([t, low]) => percent(data, t) + "," + y(low)).reverse();
  const make = (name, attributes) => {
    const node = document.createElementNS("http://www.w3.org/2000/svg", name);
    for (const [key, value] of Object.entries(attributes)) node.setAttribute(key, value);
    svg.append(node);
    return node;
  };
  make("polygon", { points: above.concat("100,100", "0,100").join(" "), fill: "var(--clear)", opacity: 0.18 });
  make("polygon", { points: above.concat(below).join(" "), fill: "none", stroke: "var(--clear)", "stroke-width": 1.5,
    "vector-effect": "non-scaling-stroke" });
  const title = make("title", {});
  title.textContent = "distance of the bodies, from 0 to " + most.toPrecision(3);
}

// More moments than these are lines, not buttons: fingers and eyes cannot separate them.
const MOST_TICKS = 40;

// What can be jumped to: a tick for each moment, or, for very many, a line of those within a pixel; a click goes to the nearest.
function makeTicks(moments, data, ticks, jump) {
  ticks.replaceChildren();
  ticks.onclick = null;
  if (moments.length > MOST_TICKS) {
    const lines = new Set(moments.map((moment) => percent(data, moment).toFixed(1)));
    for (const place of lines) {
      const line = document.createElement("i");
      line.style.left = place + "%";
      ticks.append(line);
    }
    ticks.title = moments.length + " moments; a click jumps to the nearest";
    ticks.onclick = (event) => {
      const { left, width } = ticks.getBoundingClientRect(), [t0, t1] = data.window;
      const t = t0 + (t1 - t0) * (event.clientX - left) / width;
      jump(moments.reduce((a, b) => Math.abs(a - t) <= Math.abs(b - t) ? a : b));
    };
    return;
  }
  ticks.title = "";
  for (const moment of moments) {
    const tick = document.createElement("button");
    tick.textContent = "▲";
    tick.title = "t = " + moment.toPrecision(9);
    tick.setAttribute("aria-label", "jump to t = " + moment.toPrecision(9));
    tick.style.left = percent(data, moment) + "%";
    tick.onclick = () => jump(moment);
    ticks.append(tick);
  }
}

// The distance at the curve's sample next to a time, if one is near.
function distanceText(data, t) {
  if (!data.curve || !data.curve.length) return "";
  const [t0, t1] = data.window;
  const step = (t1 - t0) / Math.max(data.curve.length - 1, 1);
  const best = data.curve.reduce((a, b) => Math.abs(a[0] - t) <= Math.abs(b[0] - t) ? a : b);
  return Math.abs(best[0] - t) <= step ? ", about " + best[2].toPrecision(3) + " apart" : "";
}
