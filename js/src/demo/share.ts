import { type Attribute, attributes } from "./options.js";

/** What of a page's own a copy elsewhere does without. */
const own = new Set<Attribute>(["aria-label", "start", "balls", "paused", "embed-url"]);

/** The address of a page that shows this demo alone: all that it is stands after the `#`. */
export function shareUrl(page: URL, get: (name: Attribute) => string | null, now: { balls: string | null; start: number }): string {
  const all = new URLSearchParams();
  for (const name of attributes) {
    const value = get(name);
    if (value !== null && !own.has(name)) all.set(name, value);
  }
  if (now.balls !== null) all.set("balls", now.balls);
  if (now.start > 0) all.set("start", String(now.start));
  const url = new URL(page);
  url.hash = all.toString();
  return url.href;
}

/** The attributes that an address holds, of those that there are. */
export function readShared(hash: string): [Attribute, string][] {
  const all = new URLSearchParams(hash.replace(/^#/, ""));
  return attributes.filter((name) => all.has(name)).map((name) => [name, all.get(name)!]);
}

/** An iframe of such a page. */
export function iframeOf(url: string, title: string, height: number): string {
  const text = (value: string): string => value.replaceAll("&", "&amp;").replaceAll('"', "&quot;").replaceAll("<", "&lt;");
  return [
    `<iframe src="${text(url)}"`,
    `  title="${text(title)}"`,
    `  style="width: 100%; max-width: 632px; height: ${Math.ceil(height)}px; border: 0"`,
    `  loading="lazy"></iframe>`,
  ].join("\n");
}
