import { type Attribute, attributes } from "./options.js";

/** What of a page's own a copy elsewhere does without. */
const own = new Set<Attribute>(["aria-label", "start", "stop", "balls", "paused", "embed-url"]);

/** Where a demo is, beside its attributes. */
interface Now {
  readonly balls: string | null;
  /** Its tick. */
  readonly start: number;
  /** The stop that it shows, where it stands at one. */
  readonly stop: number | undefined;
  readonly isPaused: boolean;
  readonly seed: number | undefined;
}

/** The address of a page that shows this demo alone: all that it is stands after the `#`. */
export function shareUrl(page: URL, get: (name: Attribute) => string | null, now: Now): string {
  const all = new URLSearchParams();
  for (const name of attributes) {
    const value = get(name);
    if (value !== null && !own.has(name)) all.set(name, value);
  }
  if (now.balls !== null) all.set("balls", now.balls);
  if (now.seed !== undefined) all.set("seed", String(now.seed));
  if (now.start > 0) all.set("start", String(now.start));
  if (now.stop !== undefined) all.set("stop", String(now.stop));
  if (now.isPaused) all.set("paused", "");
  const url = new URL(page);
  url.hash = all.toString();
  return url.href;
}

/** The address of a page that shows several demos side by side: theirs, with "|" between them, which none contains. */
export function shareTogether(urls: readonly string[]): string {
  return urls.map((url, at) => (at === 0 ? url : new URL(url).hash.slice(1))).join("|");
}

/** The attributes that an address holds, of those that there are. */
export function readShared(hash: string): [Attribute, string][] {
  const all = new URLSearchParams(hash.replace(/^#/, ""));
  return attributes.filter((name) => all.has(name)).map((name) => [name, all.get(name)!]);
}
