// What a page keeps in its address: names and numbers, as text. What is as it would be anyway is
// left out.

/** The texts of the address where it has them, else those of `defaults`. */
export function readAddress<K extends string>(defaults: Readonly<Record<K, string>>): Record<K, string> {
  const query = new URLSearchParams(location.search);
  return Object.fromEntries(Object.entries<string>(defaults).map(([key, text]) => [key, query.get(key) ?? text])) as Record<K, string>;
}

/** Writes into the address what differs from the defaults. */
export function writeAddress<K extends string>(texts: Readonly<Record<K, string>>, defaults: Readonly<Record<K, string>>): void {
  const url = new URL(location.href);
  for (const key of Object.keys(defaults) as K[]) {
    if (texts[key] === defaults[key]) url.searchParams.delete(key);
    else url.searchParams.set(key, texts[key]);
  }
  history.replaceState(history.state, "", url);
}

/** A number of the address within its bounds; `otherwise` if it is none. */
export function numberWithin(text: string, least: number, most: number, otherwise: number): number {
  const given = text.trim() === "" ? Number.NaN : Number(text);
  return given >= least && given <= most ? given : otherwise;
}
