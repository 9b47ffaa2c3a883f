// Memory stays flat on every page while everything on it runs. `./test --long` takes ten minutes for this.
import { type CDPSession, chromium, expect, test } from "@playwright/test";
import { PAGES } from "./support/pages.ts";

const MINUTES = Number(process.env["MEMORY_MINUTES"] ?? 10);
/** Code is compiled and caches are filled first. */
const SETTLING = 0.3;
/** What a page may hold more at the end than when it had settled: a history that is filled, rounding. */
const MOST_GROWTH = 2_000_000;

/** What a page and its workers hold after all garbage has been collected. */
interface Held {
  /** Objects, and the arrays and WebAssembly memories beside them. */
  readonly bytes: number;
  readonly nodes: number;
  readonly listeners: number;
  readonly workers: number;
}

interface HeapUsage {
  readonly usedSize: number;
  readonly backingStorageSize?: number;
}

const sizeOf = ({ usedSize, backingStorageSize = 0 }: HeapUsage): number => usedSize + backingStorageSize;

/** The workers of a page, which have heaps of their own. */
class Workers {
  readonly #sessions = new Set<string>();
  readonly #answers = new Map<number, (usage: HeapUsage) => void>();
  #last = 0;

  constructor(readonly page: CDPSession) {
    page.on("Target.attachedToTarget", ({ sessionId, targetInfo }) => targetInfo.type === "worker" && this.#sessions.add(sessionId));
    page.on("Target.detachedFromTarget", ({ sessionId }) => void this.#sessions.delete(sessionId));
    page.on("Target.receivedMessageFromTarget", ({ message }) => {
      const { id, result } = JSON.parse(message) as { id?: number; result: HeapUsage };
      if (id !== undefined) this.#answers.get(id)?.(result);
    });
  }

  get count(): number {
    return this.#sessions.size;
  }

  async bytes(): Promise<number> {
    const all = [...this.#sessions].map((session) => Promise.race([this.#sizeIn(session), new Promise<number>((resolve) => setTimeout(resolve, 20_000, 0))]));
    return (await Promise.all(all)).reduce((sum, size) => sum + size, 0);
  }

  async #sizeIn(sessionId: string): Promise<number> {
    const usage = async (): Promise<HeapUsage> => {
      const id = ++this.#last;
      const answer = new Promise<HeapUsage>((resolve) => this.#answers.set(id, resolve));
      await this.page.send("Target.sendMessageToTarget", { sessionId, message: JSON.stringify({ id, method: "Runtime.getHeapUsage" }) });
      return answer;
    };
    await this.page.send("Target.sendMessageToTarget", { sessionId, message: JSON.stringify({ id: ++this.#last, method: "HeapProfiler.collectGarbage" }) });
    return sizeOf(await usage());
  }
}

async function measure(page: CDPSession, workers: Workers): Promise<Held> {
  await page.send("HeapProfiler.collectGarbage");
  const { metrics } = await page.send("Performance.getMetrics");
  const metric = (wanted: string): number => metrics.find(({ name }) => name === wanted)?.value ?? Number.NaN;
  const bytes = sizeOf((await page.send("Runtime.getHeapUsage")) as HeapUsage) + (await workers.bytes());
  return { bytes, nodes: metric("Nodes"), listeners: metric("JSEventListeners"), workers: workers.count };
}

test(`memory is flat over ${MINUTES} minutes on every page`, async ({ baseURL, launchOptions }) => {
  test.setTimeout((MINUTES + 10) * 60_000);
  // Pages that are not in front run as well.
  const args = [...(launchOptions.args ?? []), "--disable-background-timer-throttling", "--disable-renderer-backgrounding", "--disable-backgrounding-occluded-windows"];
  const browser = await chromium.launch({ ...launchOptions, args });
  const context = await browser.newContext({ baseURL: baseURL!, viewport: { width: 1280, height: 900 }, serviceWorkers: "block" });
  const all: { path: string; session: CDPSession; workers: Workers; held: Held[] }[] = [];
  for (const path of PAGES) {
    const page = await context.newPage();
    const session = await context.newCDPSession(page);
    const workers = new Workers(session);
    await session.send("Target.setAutoAttach", { autoAttach: true, waitForDebuggerOnStart: false, flatten: false });
    await session.send("HeapProfiler.enable");
    await session.send("Performance.enable");
    await page.goto(path === "/embed.html" ? "/embed.html#strategy=swap&balls=20&decorations=checks" : path);
    // A reader who goes on and on through the page, so that each of its parts runs now and then.
    await page.evaluate(() => {
      let y = 0;
      setInterval(() => {
        y = y + 0.6 * innerHeight > document.documentElement.scrollHeight ? 0 : y + 0.6 * innerHeight;
        scrollTo({ top: y, behavior: "instant" });
      }, 1500);
    });
    all.push({ path, session, workers, held: [] });
  }
  const moments = Math.max(6, Math.round(MINUTES * 2));
  for (let moment = 0; moment < moments; moment++) {
    await new Promise((resolve) => setTimeout(resolve, (MINUTES * 60_000) / moments));
    for (const { session, workers, held } of all) held.push(await measure(session, workers));
  }
  await browser.close();
  const settled = Math.floor(SETTLING * moments);
  const half = settled + Math.floor((moments - settled) / 2);
  for (const { path, held } of all) {
    const [first, last] = [held[settled]!, held.at(-1)!];
    console.log(`${path}: ${held.map(({ bytes }) => (bytes / 1e6).toFixed(1)).join(", ")} MB; ${first.nodes} to ${last.nodes} nodes, ${first.listeners} to ${last.listeners} listeners, ${last.workers} workers`);
    // The least of the last half is compared: what is being worked on at a moment is no leak.
    for (const [name, limit] of [["bytes", MOST_GROWTH], ["nodes", 200], ["listeners", 50], ["workers", 1]] as const) {
      const values = held.map((one) => one[name]);
      const growth = Math.min(...values.slice(half)) - Math.max(...values.slice(settled, half));
      expect.soft(growth, `${path}: growth in ${name}`).toBeLessThan(limit);
    }
  }
});
