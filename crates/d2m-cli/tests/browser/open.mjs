// A real browser without a window, for pages that fetch nothing. playwright-core is taken from the folder in which node was started.
import { createRequire } from "node:module";
import { join } from "node:path";

export async function launch(executablePath) {
  const { chromium } = createRequire(join(process.cwd(), "from"))("playwright-core");
  const flags = ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"];
  return chromium.launch({ executablePath, args: flags });
}

// Opens a page; its faults are errors on the console, exceptions and anything that is fetched.
export async function open(browser, path, { width = 1280, height = 800, hash = "" } = {}) {
  const page = await browser.newPage({ viewport: { width, height } });
  const faults = [];
  page.on("console", (message) => { if (message.type() === "error") faults.push(message.text()); });
  page.on("pageerror", (error) => faults.push(String(error)));
  page.on("request", (request) => { if (!request.url().startsWith("file:")) faults.push("fetches " + request.url()); });
  await page.goto("file://" + path + "#" + hash);
  await page.waitForFunction(() => window.d2m);
  const state = () => page.evaluate(() => window.d2m.state());
  return { page, faults, state };
}

// Each of these elements lies on the screen.
export async function onScreen(page, ids, { width, height }) {
  for (const id of ids) {
    const box = await page.locator("#" + id).boundingBox();
    if (!box || box.x < 0 || box.x + box.width > width || box.y < 0 || box.y + box.height > height) {
      throw new Error(`${id} is not on the screen: ${JSON.stringify(box)}`);
    }
  }
}
