// Puts the page of `d2m view`, three.js, the engine and the sliders into one file that fetches nothing:
//     node make.mjs PKG OUT.html
// PKG: the folder with d2m_wasm.js and d2m_wasm_bg.wasm as `wasm-bindgen --target no-modules` writes them.
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { fileURLToPath } from "node:url";

const [pkg, out] = process.argv.slice(2);
const here = fileURLToPath(new URL(".", import.meta.url)), cli = join(here, "../../d2m-cli");
const text = (...path) => readFileSync(join(...path), "utf8");
const own = (name) => text(here, name), view = (name) => text(cli, "src/view/page", name);

// Puts each part in once, and never looks through it for the places of others.
function filled(page, parts) {
  let done = "";
  for (const [place, part] of parts) {
    const halves = page.split(place);
    if (halves.length !== 2) throw new Error(`the page has ${halves.length - 1} times ${place}`);
    done += halves[0] + part;
    page = halves[1];
  }
  return done + page;
}

const wasm = readFileSync(join(pkg, "d2m_wasm_bg.wasm")).toString("base64");
const scripts = ["bodies.js", "marks.js", "timeline.js", "frame.js", "main.js"].map(view);
const facts = '<dl id="facts">';
writeFileSync(out, filled(view("page.html"), [
  ["<title>d2m view</title>", "<title>d2m in the page</title>"],
  ["{{STYLE}}", view("style.css") + own("motion.css")],
  [facts, own("motion.html") + "  " + facts],
  ["{{DATA}}", `null</script>\n<script type="application/wasm" id="wasm">${wasm}`],
  ["{{THREE}}", text(cli, "assets/three/three.min.js")],
  ["{{SCRIPT}}", ['"use strict";', ...scripts, text(pkg, "d2m_wasm.js"), own("live.js")].join("\n")],
]));
