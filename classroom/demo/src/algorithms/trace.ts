/** What the records of a trace are, by kind less one. */
const kinds = [
  ["step", "axis", "keeps"],
  ["array", "axis"],
  ["compare", "a", "b"],
  ["swap", "i", "j", "a", "b"],
  ["visit", "position", "edge"],
  ["enter", "id"],
  ["leave", "id"],
  ["prune", "axis", "left", "right"],
  ["test", "a", "b", "axis", "left"],
  ["axis overlap", "axis", "a", "b"],
  ["axis apart", "axis", "a", "b"],
  ["overlap", "a", "b"],
  ["begin", "a", "b"],
  ["end", "a", "b"],
] as const;

/** One recorded event: its kind, and its words by name (see {@link events}). */
export interface TraceEvent {
  /** Which event. */
  kind: (typeof kinds)[number][0];
  /** Its words, by name; of an array only the axis. */
  [word: string]: number | string;
}

/**
 * The events of a trace, one by one.
 *
 * | kind | words |
 * |---|---|
 * | step | axis; keeps: 1 if earlier axis overlaps still stand |
 * | array | axis: the endpoints on it are rewritten; see `Player` |
 * | compare | a, b: the sort compared two edges |
 * | swap | i, j, a, b: the sort exchanged positions i and j, where the edges a and b stood |
 * | visit | position, edge: the sweep line reached this endpoint |
 * | enter, leave | id: the sweep reached a box, or left it behind |
 * | prune | axis, left, right: `left` ends before `right` begins, so a scan ends here |
 * | test | a, b, axis, left: a box test; `axis` separates and `left` ends first there, or both are 2^32 - 1 |
 * | axis overlap, axis apart | axis, a, b: a pair overlaps on a swept axis, or no longer does |
 * | overlap, begin, end | a, b: a pair |
 *
 * An edge is `2 * box` for the left end and one more for the right one.
 *
 * @throws During iteration: `TypeError` if `words` is not a `Uint32Array`, `RangeError` at words that
 *   are not an event.
 */
export function* events(words: Uint32Array): Generator<TraceEvent, void, undefined> {
  if (!(ArrayBuffer.isView(words) && words[Symbol.toStringTag] === "Uint32Array")) {
    throw new TypeError("a trace must be a Uint32Array");
  }
  for (let at = 0, length; at < words.length; at += length) {
    length = words[at]! >>> 8;
    const names = kinds[(words[at]! & 255) - 1];
    if (names === undefined || length < names.length || at + length > words.length) {
      throw new RangeError(`no event begins at word ${at}: these words are not a trace`);
    }
    yield eventAt(words, at);
  }
}

/** The event whose record begins at a word. */
export function eventAt(words: Uint32Array, at: number): TraceEvent {
  const [kind, ...names] = kinds[(words[at]! & 255) - 1]!;
  const event: TraceEvent = { kind };
  names.forEach((name, index) => (event[name] = words[at + 1 + index]!));
  return event;
}

/** The length of the record that ends before a word. */
export function lengthBefore(words: Uint32Array, at: number): number {
  return words[at - 1]! >>> 8;
}
