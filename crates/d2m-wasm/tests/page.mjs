// Opens the page with the engine in a real browser and holds what it shows against the engine, and that against the command:
//     npm install playwright-core && node page.mjs PAGE D2M [BROWSER [FOLDER]]
// PAGE: what page/make.mjs wrote; FOLDER: where pictures go (default: the temporary one).
import { execFileSync } from "node:child_process";
import { mkdtempSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import assert from "node:assert/strict";
import { launch, onScreen, open } from "../../d2m-cli/tests/browser/open.mjs";

const [file, command, executablePath = "/usr/bin/chromium", folder = mkdtempSync(join(tmpdir(), "d2m-page-"))] = process.argv.slice(2);
const browser = await launch(executablePath);

// What the native command answers to what the page asked.
function native({ names, motions }) {
  const paths = motions.map((motion, i) => { const path = join(folder, `motion${i}.json`); writeFileSync(path, JSON.stringify(motion)); return path; });
  const words = ["toc", ...names.map((name) => "shape:" + name), "--motion-a", "@" + paths[0], "--motion-b", "@" + paths[1], "--clearance", "--json"];
  return JSON.parse(execFileSync(command, words, { encoding: "utf8", stdio: ["ignore", "pipe", "ignore"] }));
}

for (const [width, height, theme] of [[1280, 800, "light"], [1280, 800, "dark"], [800, 600, "light"], [800, 600, "dark"], [390, 800, "light"], [390, 800, "dark"]]) {
  const { page, faults, state } = await open(browser, resolve(file), { width, height, hash: "theme=" + theme });
  const last = () => page.evaluate(() => window.d2m.last());
  const answered = async (change) => {
    const before = JSON.stringify((await last()).motions) + JSON.stringify((await last()).names);
    await change();
    await page.waitForFunction((before) => JSON.stringify(window.d2m.last().motions) + JSON.stringify(window.d2m.last().names) !== before, before);
    return last();
  };
  const slide = (id, value) => answered(() => page.locator("#" + id).fill(String(value)));
  // What is shown is what was computed, here and by the command.
  const judge = async (found) => {
    const { answer, motions } = found, theirs = native(found), now = await state();
    for (const key of ["status", "toc", "toc_hi", "normal", "point_a", "point_b", "feature", "clearance", "evidence"]) {
      assert.deepEqual(answer[key], theirs[key], key);
    }
    assert.equal(await page.locator("#headline").textContent(), answer.headline);
    const facts = await page.locator("#facts dt, #facts dd").allTextContents();
    assert.deepEqual(facts, answer.facts.flat());
    if (answer.status === "contact") {
      assert.ok(answer.headline.includes(String(answer.toc)), answer.headline);
      assert.ok(now.time === answer.toc && now.span === "contact" && now.marks === 1, JSON.stringify(now));
      assert.ok(facts.includes("normal") && facts.includes("evidence"));
    } else {
      assert.ok(answer.headline === "SEPARATED" && now.marks === 0 && facts.includes("clearance"), JSON.stringify(facts));
    }
    // Bodies are where the motion has them: shown by single precision and rounded times.
    const { x, v } = motions[0];
    now.bodies[0].forEach((c, i) => assert.ok(Math.abs(c - (x[i] + v[i] * now.time)) < 1e-2, `${c}`));
  };
  const first = await last();
  await judge(first);
  assert.equal(first.answer.status, "contact");
  await page.screenshot({ path: join(folder, `page-${width}-${theme}.png`) });

  const faster = await slide("vx", 6.5);
  assert.ok(faster.answer.status === "contact" && faster.answer.toc < first.answer.toc, "a faster body is there earlier");
  await judge(faster);
  const turned = await slide("wz", -7.4);
  assert.ok(turned.answer.toc !== faster.answer.toc, "the spin changes the time");
  await judge(turned);
  await judge(await slide("wx", 5));
  const away = await slide("vx", -4);
  assert.equal(away.answer.status, "separated");
  await judge(away);
  await page.screenshot({ path: join(folder, `page-${width}-${theme}-separated.png`) });
  // The keyboard moves a slider, not the time.
  await page.locator("#vx").focus();
  const { time } = await state();
  await answered(() => page.keyboard.press("ArrowRight"));
  assert.equal((await last()).motions[0].v[0], -3.95);
  assert.equal((await state()).time, time);
  // Another body.
  const chosen = await answered(() => page.locator("#shape-b").selectOption("torus-knot?triangles=2000"));
  await judge(chosen);
  await judge(await slide("vx", 5));
  await page.screenshot({ path: join(folder, `page-${width}-${theme}-knot.png`) });
  // Elsewhere the keys are the page's.
  await page.locator("#stage").click({ position: { x: width - 60, y: height / 2 } });
  await page.evaluate(() => document.activeElement.blur());
  await page.keyboard.press("Home");
  assert.equal((await state()).time, 0);
  await page.keyboard.press("c");
  assert.equal((await state()).time, (await last()).answer.toc);
  // All of it is on the screen, and nothing is covered.
  await onScreen(page, ["panel", "tools", "bar"], { width, height });
  const [panel, tools, bar] = await Promise.all(["panel", "tools", "bar"].map((id) => page.locator("#" + id).boundingBox()));
  const apart = (p, q) => p.x + p.width <= q.x || q.x + q.width <= p.x || p.y + p.height <= q.y || q.y + q.height <= p.y;
  assert.ok(apart(panel, tools) && apart(panel, bar) && apart(tools, bar), JSON.stringify({ panel, tools, bar }));
  assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= window.innerWidth), "nothing is wider than the screen");
  for (const label of await page.locator("#motion label").all()) {
    assert.ok(await label.getAttribute("for"), "each slider has a label");
  }
  assert.deepEqual(faults, []);
  await page.close();
}
await browser.close();
console.log("the page holds; pictures in " + folder);
