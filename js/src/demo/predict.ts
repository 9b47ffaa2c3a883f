import type { TraceEvent } from "../trace.js";
import { describeEvent, inWords } from "./narrate.js";
import type { Timeline } from "./timeline.js";

/** What a visitor is asked before an event is shown. */
export interface Question {
  readonly text: string;
  readonly choices: readonly [string, string];
  /** Which of the choices is right. */
  readonly answer: 0 | 1;
  /** Why, in a sentence. */
  readonly why: string;
}

/** How the guesses so far turned out. */
export class Guesses {
  /** Of the last one, in words; empty once that is past. */
  outcome = "";
  right = 0;
  made = 0;

  count(question: Question, choice: 0 | 1): void {
    const isRight = choice === question.answer;
    this.outcome = isRight ? "Right." : `No: ${question.choices[question.answer]}. ${question.why}`;
    this.right += Number(isRight);
    this.made++;
  }
}

/** The question about what comes next in a detection, if there is a good one. */
export function questionAt({ nextPosition, detection, state }: Timeline, names: readonly string[]): Question | undefined {
  const next = nextPosition === undefined ? undefined : detection.events[nextPosition - 1];
  if (!next) return undefined;
  const prunes = detection.events.some(({ kind }) => kind === "prune");
  return questionOf(next, { after: detection.events[nextPosition!], prunes, names, boxes: detection.boxes, axis: state.arrayAxis });
}

const NONE = 2 ** 32 - 1;

/** What a question depends on, beside the event that it is about. */
interface Known {
  /** The event that follows it in the trace. */
  readonly after: TraceEvent | undefined;
  /** Whether the algorithm ends scans early. */
  readonly prunes: boolean;
  readonly names: readonly string[];
  readonly boxes: Float64Array;
  /** The axis whose endpoints are sorted. */
  readonly axis: number;
}

/** The question about the event that comes next, if there is a good one. */
function questionOf(next: TraceEvent, known: Known): Question | undefined {
  const { after, prunes, names, boxes, axis } = known;
  const word = (name: string): number => Number(next[name]);
  const name = (ball: number): string => names[ball] ?? String(ball);
  const edge = (at: number): string => (at % 2 === 0 ? `(${name(at >> 1)}` : `${name(at >> 1)})`);
  const place = (at: number): string => inWords(boxes[4 * (at >> 1) + 2 * (at % 2) + axis] ?? 0);
  const why = describeEvent(next, { boxes, names });
  switch (next.kind) {
    case "test":
      if (prunes) return tested(name(word("a")), name(word("b")), 0, why);
      return {
        text: `${name(word("a"))} and ${name(word("b"))} are tested next. Their boxes …`,
        choices: ["overlap", "are apart"],
        answer: word("left") === NONE ? 0 : 1,
        why,
      };
    case "prune":
      return tested(name(word("left")), name(word("right")), 1, why);
    case "compare":
      return {
        text: `${edge(word("a"))} is compared with ${edge(word("b"))}. They …`,
        choices: ["swap", "stay"],
        answer: after?.kind === "swap" ? 0 : 1,
        why: `${edge(word("a"))} is at ${place(word("a"))}, ${edge(word("b"))} at ${place(word("b"))}.`,
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
