// The words that this project does not use, and where they still stand.
//
//   node tests/vocabulary.mjs           the words, and what to write instead
//   node tests/vocabulary.mjs --list    each place where one of them stands
import { execFileSync } from "node:child_process";
import { existsSync, readFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

export const root = dirname(dirname(fileURLToPath(import.meta.url)));

/**
 * The left column of the glossary, as patterns, and what to write instead. `only` limits a word to the
 * files where it had a meaning of its own; elsewhere it is plain English.
 */
export const WORDS = [
  { not: "living world", but: "persistent broad phase", pattern: /\bliving[ _]worlds?\b/i },
  {
    not: "follow a world, bodies",
    but: "track, update",
    pattern:
      /\bfollow(s|ed|ing)? (a |the |its |their |every |each )?(living )?(world|bod(y|ies)|box(es)?)\b|\b(world|bod(y|ies))s? (is |are )?followed\b|\bfn \w*follow\w*|\bstruct Follow\w*|\bfollow\(|\bmod follow/i,
  },
  { not: "anew", but: "from scratch", pattern: /anew(?![a-z])/i },
  { not: "fast road", but: "fast path", pattern: /\bfast roads?\b/i },
  { not: "door", but: "API, binding, FFI boundary", pattern: /\bdoors?\b/i },
  { not: "fat box", but: "fattened AABB, fat AABB", pattern: /fat[ _]?box/i },
  { not: "least corner, greatest corner", but: "min corner, max corner", pattern: /\b(least|greatest)[ _]corner/i },
  { not: "seat, wear", but: "dense index, locality decay", pattern: /(?<!pau)seat(s|ed|ing)?(?![a-z])|(?<![a-z])wear(?![a-z])/i },
  { not: "loner", but: "unpaired body", pattern: /(?<![a-z])loner/i },
  {
    not: "called from memory, warm",
    but: "prefetched, preloaded",
    pattern: /\bcall(s|ed)? (\w+ )?from memory\b|(?<![a-z])warm(s|ed|ing|er)?(?![a-z])(?!.?up)/i,
  },
  {
    not: "shares, stretches, pieces (of work)",
    but: "chunks",
    pattern: /(?<![a-z])stretch(es)?(?![a-z])|(?<![a-z])pieces?(?![a-z])|\b(struct|enum|type) \w*(Share|Part)\b/i,
  },
  { not: "bins, strips (of the grid)", but: "columns", pattern: /(?<![a-z./])bins?(?![a-z/])|\bstrips\b/i, only: /\.(rs|md|py|ts)$/ },
  { not: "bracket", but: "endpoint", pattern: /(?<![a-z])brackets?(?![a-z])/i },
  {
    not: "ours, rival, peer, contender",
    but: "sweep-and-prune, alternative",
    pattern: /(?<![a-z])ours(?![a-z])|rivals?(?![a-z])|(?<![a-z])peers?(?![a-z])|contenders?(?![a-z])/i,
  },
  {
    not: "watched, broken off, had enough",
    but: "with a progress callback, cancelled",
    pattern: /(?<![a-z])watched(?![a-z])|\bbroken off\b|\bbreaks? off\b|\bhad enough\b|\b(struct|enum|impl|for) Enough\b|\bEnough(::|\()/,
  },
  { not: "lab, laboratory", but: "broken variant, shown on purpose", pattern: /(?<![a-z])labs?(?![a-z])|laborator(y|ies)/i },
  { not: "lit", but: "highlighted", pattern: /\blit\b/i },
  { not: "effort", but: "cost policy", pattern: /(?<![a-z])efforts?(?![a-z])/i },
  {
    not: "again, last (the coherence cache)",
    but: "coherence cache",
    pattern: /\b(mod|fn|struct|self\.) ?again\b|\bstruct Last\b|again\.rs|_AGAIN\b/,
  },
  { not: "marks", but: "dedup bitmap", pattern: /(?<![a-z])marks(?![a-z])/i, only: /^core\/src/ },
  { not: "hull", but: "union", pattern: /(?<![a-z])hulls?(?![a-z])/i },
  { not: "room", but: "spare capacity", pattern: /(?<![a-z])room(?![a-z])/i, only: /\.(rs|py|md)$/ },
  {
    not: "Places, Ruler, Arrange, tell",
    but: "cell coordinates, quantizer, pair order, report",
    pattern: /\bPlaces\b|\bRuler\b|\bArrange\b|\b(fn|function|const|let|mod) (tell|told)(?![a-z])|[./]tell\(|\btold[./]/,
  },
  { not: "the interpreter's lock", but: "the GIL", pattern: /interpreter['’]s lock/i },
  { not: "all with all, all pairs tested", but: "brute force", pattern: /\ball[ _]with[ _]all\b|\ball pairs tested\b/i },
  { not: "turned boxes", but: "rotated (oriented) boxes", pattern: /\bturned box/i },
  { not: "comes down to", but: "the exact verb", pattern: /\b(comes?|came) down to\b/i },
  {
    not: "who, somebody, nobody (for a thing)",
    but: "it, which",
    pattern: /\b(somebody|whoever|nobody)\b|\b(bod(y|ies)|box(es)?|threads?|those|ones?) who\b/i,
  },
  {
    not: "so many (a number)",
    but: "this many, N, or the name of the number",
    pattern: /\bso many\b(?! that\b)/i,
    only: /^(?!fuzz\/TOTALS)/,
  },
  {
    not: "those of, twice in a sentence",
    but: "the noun again",
    pattern: /\bthose of\b[^.;]*\bthose of\b/i,
    only: /\.(rs|ts|js|mjs|py)$/,
  },
  {
    not: "British spelling",
    but: "American spelling",
    pattern: /neighbour|colour|behaviour|(?<![a-z])centre|serialis|optimis(e|ation)|normalis|initialis/i,
  },
];

/** Legitimate uses: where, of which word, and why. `line` narrows them to lines that match. */
export const EXCEPTIONS = [
  { path: /./, not: "lit", line: /["'`]lit["'`/]|lit\/|\bLit(Element)?\b/, why: "Lit is the library that the elements are written with" },
  { path: /./, not: "called from memory, warm", line: /warm.?up/i, why: "the warm-up of a benchmark" },
  { path: /(package(-lock)?\.json|\.toml)$/, not: "ours, rival, peer, contender", line: /peerDependencies|peer"/, why: "a key of npm" },
  {
    path: /^core\/(examples\/sensors|src\/world\/broad_phase)\.rs$/,
    not: "door",
    line: /\bdoor\b/,
    why: "a door in the world of a game",
  },
  { path: /./, not: "hull", line: /convex hull/i, why: "a convex hull is the field's term" },
  { path: /./, not: "bins, strips (of the grid)", line: /\[\[bin\]\]|--bin\b|src\/bin|bin\/|CARGO_BIN_EXE/, why: "a binary of Cargo" },
];

const SKIPPED =
  /^((\w+\/)*LICENSE|tests\/(vocabulary|support\/)|\.tools|bench\/(js\/)?results\/)|package-lock\.json$|Cargo\.lock$|\.(png|svg|webp|ico|snap|json5?|wasm|gif)$/;
const KEPT_JSON = /package\.json$/;

const isException = (path, not, line) =>
  EXCEPTIONS.some((it) => it.not === not && it.path.test(path) && (!it.line || it.line.test(line)));

/** Every place of a text that has one of the words: { path, line, word, text }. The path itself is line 0. */
export function placesIn(path, text) {
  const lines = [path, ...text.split("\n")];
  // `labOptions` has the word "lab" too.
  const split = lines.map((line) => line.replace(/([a-z])(?=[A-Z])/g, "$1 "));
  return WORDS.filter(({ only }) => !only || only.test(path)).flatMap((word) =>
    lines.flatMap((line, number) =>
      (word.pattern.test(line) || word.pattern.test(split[number])) && !isException(path, word.not, line)
        ? [{ path, line: number, word, text: line.trim() }]
        : [],
    ),
  );
}

/** Every place in the files of the repository, those that Git ignores left out. */
export function places() {
  const files = execFileSync("git", ["ls-files", "--cached", "--others", "--exclude-standard"], {
    cwd: root,
    encoding: "utf8",
  });
  const wanted = files
    .split("\n")
    .filter((path) => path && (KEPT_JSON.test(path) || !SKIPPED.test(path)) && existsSync(join(root, path)));
  return wanted.flatMap((path) => placesIn(path, readFileSync(join(root, path), "utf8")));
}

export const describe = ({ path, line, word, text }) =>
  `${path}${line ? `:${line}` : " (its name)"}: not "${word.not}", but "${word.but}": ${text.slice(0, 120)}`;

if (process.argv[1] === fileURLToPath(import.meta.url)) {
  if (process.argv[2] === "--list") for (const place of places()) console.log(describe(place));
  else for (const { not, but } of WORDS) console.log(`${not} -> ${but}`);
}
