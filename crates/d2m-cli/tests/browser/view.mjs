// Opens pages of `d2m view` in a real browser without a window and holds them against what they must show:
//     npm install playwright-core && node view.mjs D2M [BROWSER [FOLDER]]
// D2M is the command, BROWSER a Chromium (default /usr/bin/chromium), FOLDER where pictures go (default: the temporary one).
import { execFileSync } from "node:child_process";
import { mkdtempSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { fileURLToPath } from "node:url";
import assert from "node:assert/strict";
import { launch, onScreen, open } from "./open.mjs";

const [command, executablePath = "/usr/bin/chromium", folder = mkdtempSync(join(tmpdir(), "d2m-view-"))] = process.argv.slice(2);
const scenes = fileURLToPath(new URL("../../../../docs/scenes", import.meta.url));
const browser = await launch(executablePath);

const pair = join(folder, "pair.html");
execFileSync(command, ["view", "shape:box?x=1&y=1&z=1", "shape:box?x=1&y=1&z=1", "--out", pair, "--motion-a", "x=-3,0,0;v=4,0,0"]);
for (const [width, height, theme] of [[1280, 800, "light"], [800, 600, "dark"], [390, 800, "light"], [390, 800, "dark"]]) {
  const { page, faults, state } = await open(browser, pair, { width, height, hash: "theme=" + theme });
  // It opens at the contact: a quarter of the window. The box has moved by one there.
  let now = await state();
  assert.ok(Math.abs(now.time - 0.25) < 1e-8 && now.span === "contact" && now.marks === 1, JSON.stringify(now));
  assert.ok(Math.abs(now.bodies[0][0] + 2) < 1e-7, "A is where the certified answer has it");
  const pictures = [await page.screenshot({ path: join(folder, `pair-${width}-${theme}.png`) })];
  // Nothing covers the contact.
  const under = await page.evaluate(([x, y]) => document.elementFromPoint(x, y).tagName, now.mark);
  assert.equal(under, "CANVAS", JSON.stringify(now.mark));
  // The slider moves the bodies, and what holds is said.
  await page.locator("#time").fill("1000");
  now = await state();
  assert.ok(Math.abs(now.time - 0.1) < 1e-9 && now.span === "clear" && now.marks === 0, JSON.stringify(now));
  assert.ok(Math.abs(now.bodies[0][0] + 2.6) < 1e-7);
  await page.locator("#time").fill("9000");
  assert.equal((await state()).span, "unknown", "nothing is claimed of times that were not examined");
  // Keys and buttons.
  await page.keyboard.press("c");
  assert.ok(Math.abs((await state()).time - 0.25) < 1e-8);
  for (const id of ["cut", "ghost", "paths", "wire"]) {
    await page.locator("#" + id).click();
    assert.equal(await page.locator("#" + id).getAttribute("aria-pressed"), "true");
  }
  await page.waitForTimeout(100);
  pictures.push(await page.screenshot());
  assert.ok(!pictures[0].equals(pictures[1]), "cut and ghost change the picture");
  // Near the contact, and back.
  const far = await page.screenshot();
  await page.keyboard.press("n");
  await page.waitForTimeout(100);
  assert.equal(await page.locator("#near").getAttribute("aria-pressed"), "true");
  assert.ok(!far.equals(await page.screenshot()), "coming near changes the picture");
  await page.keyboard.press("n");
  // Nothing leaves the screen or covers the slider.
  await onScreen(page, ["panel", "tools", "bar", "axes", "scale"], { width, height });
  const [tools, bar] = [await page.locator("#tools").boundingBox(), await page.locator("#bar").boundingBox()];
  assert.ok(tools.y + tools.height <= bar.y, "the buttons are above the slider");
  assert.deepEqual(faults, []);
  await page.close();
}

// Many bodies and many moments: a simulation, and every body in its place at every time.
const run = join(folder, "run.jsonl"), simulated = join(folder, "run.html");
execFileSync(command, ["simulate", join(scenes, "pile.json"), "--out", run], { stdio: "ignore" });
execFileSync(command, ["view", run, "--out", simulated]);
for (const [width, height, theme] of [[1280, 800, "dark"], [390, 800, "light"]]) {
  const { page, faults, state } = await open(browser, simulated, { width, height, hash: "theme=" + theme });
  const ticks = page.locator("#ticks i");
  assert.ok(await ticks.count() > 20, "moments are marked");
  await page.locator("#ticks").click({ position: { x: 60, y: 6 } });
  const now = await state();
  assert.ok(now.marks > 0 && now.span === "clear", JSON.stringify(now));
  await page.keyboard.press("End");
  await page.waitForTimeout(100);
  await page.screenshot({ path: join(folder, `run-${width}-${theme}.png`) });
  assert.deepEqual(faults, []);
  await page.close();
}
await browser.close();
console.log("pages hold; pictures in " + folder);
