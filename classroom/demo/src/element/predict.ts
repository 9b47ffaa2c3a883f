import type { TraceEvent } from "../algorithms/trace.js";
import { describeEvent, inWords, type Known } from "./narrate.js";
import type { Timeline } from "./timeline.js";

/** What a visitor is asked before something is shown. */
export interface Question {
  readonly text: string;
  /** Two or three. */
  readonly choices: readonly string[];
  /** Which of the choices is right. */
  readonly answer: number;
  /** Why, in a sentence. */
  readonly why: string;
}

/** How the guesses so far turned out. */
export class Guesses {
  /** Of the last one, in words; empty once that is past. */
  outcome = "";
  right = 0;
  made = 0;

  count(question: Question, choice: number): void {
    const isRight = choice === question.answer;
    this.outcome = isRight ? "Right." : `No: ${question.choices[question.answer]}. ${question.why}`;
    this.right += Number(isRight);
    this.made++;
  }
}

/** The question about what comes next in a detection, if there is a good one. */
export function questionAt({ coming, detection, state }: Timeline, known: Known): Question | undefined {
  const [next, after] = coming;
  if (!next || (next.kind === "compare" && !comparisonsAsked(detection, known, state.arrayAxis).has(next))) return undefined;
  const prunes = detection.events.some(({ kind }) => kind === "prune");
  return questionOf(next, { ...known, after, prunes, sorted: state.arrayAxis });
}

const NONE = 2 ** 32 - 1;

/**
 * The comparisons of a detection that are worth a guess: those that lead to a swap, and as many others, of the endpoints that are
 * nearest to each other. Of nothing but those that stay there is nothing to guess, and the two ends of one ball never swap.
 */
function comparisonsAsked({ events }: Pick<Timeline["detection"], "events">, { boxes }: Known, axis: number): Set<TraceEvent> {
  const at = (edge: number): number => boxes[4 * (edge >> 1) + 2 * (edge % 2) + axis] ?? 0;
  const gap = ({ a, b }: TraceEvent): number => Math.abs(at(Number(a)) - at(Number(b)));
  const compared = events.filter(({ kind, a, b }) => kind === "compare" && Number(a) >> 1 !== Number(b) >> 1);
  const swaps = new Set(compared.filter((event) => events[events.indexOf(event) + 1]?.kind === "swap"));
  const stays = compared.filter((event) => !swaps.has(event)).sort((a, b) => gap(a) - gap(b));
  return new Set([...swaps, ...stays.slice(0, swaps.size)]);
}

/** What a question depends on, beside the event that it is about. */
interface Context extends Known {
  /** The event that follows it in the trace. */
  readonly after: TraceEvent | undefined;
  /** Whether the algorithm ends scans early. */
  readonly prunes: boolean;
  /** The axis whose endpoints are sorted. */
  readonly sorted: number;
}

/** The question about the event that comes next, if there is a good one. */
function questionOf(next: TraceEvent, context: Context): Question | undefined {
  const { after, prunes, names, boxes, sorted, swapsTell } = context;
  const word = (name: string): number => Number(next[name]);
  const name = (ball: number): string => names[ball] ?? String(ball);
  const edge = (at: number): string => (at % 2 === 0 ? `(${name(at >> 1)}` : `${name(at >> 1)})`);
  const place = (at: number): string => inWords(boxes[4 * (at >> 1) + 2 * (at % 2) + sorted] ?? 0);
  const why = describeEvent(next, context);
  const [a, b] = [word("a"), word("b")];
  switch (next.kind) {
    case "test":
      if (prunes) return tested(name(a), name(b), 0, why);
      return { text: `${name(a)} and ${name(b)} are tested next. Their boxes …`, choices: ["overlap", "are apart"], answer: word("left") === NONE ? 0 : 1, why };
    case "prune":
      return tested(name(word("left")), name(word("right")), 1, why);
    case "compare":
      // Where swaps tell something, they are the question. The pivot of quicksort also meets itself.
      if (swapsTell || a === b) return undefined;
      return {
        text: `${edge(a)} is compared with ${edge(b)}. They …`,
        choices: ["swap", "stay"],
        answer: after?.kind === "swap" ? 0 : 1,
        why: `${edge(a)} is at ${place(a)}, ${edge(b)} at ${place(b)}.`,
      };
    case "swap":
      if (!swapsTell) return undefined;
      return {
        text: `${edge(a)} and ${edge(b)} swap. What does that do to overlaps?`,
        choices: ["one begins", "one ends", "nothing"],
        answer: a % 2 === b % 2 ? 2 : a % 2 === 1 ? 0 : 1,
        why,
      };
    case "enter":
    case "leave":
      return { text: "What does the line do next?", choices: ["enter a ball", "leave one"], answer: next.kind === "enter" ? 0 : 1, why };
    default:
      return undefined;
  }
}

function tested(a: string, b: string, answer: 0 | 1, why: string): Question {
  return { text: `Next in order for ${a} comes ${b}. The pair is …`, choices: ["tested", "skipped"], answer, why };
}

/** Of each other ball, whether the scan from the one in focus finds it: to be asked before the scan is shown. */
export function questionsOfScan({ detection }: Timeline, focus: number, { boxes, names, axis }: Known): Question[] {
  const [min, max] = [(ball: number): number => boxes[4 * ball + axis]!, (ball: number): number => boxes[4 * ball + 2 + axis]!];
  const scanned = names[focus]!;
  return names.flatMap((other, ball): Question[] => {
    if (ball === focus) return [];
    const isFound = detection.events.some(({ kind, a, b }) => kind === "test" && (a === ball || b === ball));
    const encloses = min(ball) < min(focus) && max(ball) > max(focus);
    const within = `between (${scanned} and ${scanned})`;
    const why = isFound
      ? `An endpoint of ${other} lies ${within}.`
      : `No endpoint of ${other} lies ${within}${encloses ? `: ${other} begins before ${scanned} and ends after it, and so it is missed` : ""}.`;
    return [{ text: `Does the scan from ${scanned} find ${other}?`, choices: ["yes", "no"], answer: isFound ? 0 : 1, why }];
  });
}
