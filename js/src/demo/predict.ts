import type { TraceEvent } from "../trace.js";
import type { Timeline } from "./timeline.js";

/** What a visitor is asked before an event is shown. */
export interface Question {
  readonly text: string;
  readonly choices: readonly [string, string];
  /** Which of the choices is right. */
  readonly answer: 0 | 1;
}

/** How the guesses so far turned out. */
export class Guesses {
  /** Of the last one, in words; empty once that is past. */
  outcome = "";
  right = 0;
  made = 0;

  count(question: Question, choice: 0 | 1): void {
    const isRight = choice === question.answer;
    this.outcome = isRight ? "Right." : `No: ${question.choices[question.answer]}.`;
    this.right += Number(isRight);
    this.made++;
  }
}

/** The question about what comes next in a detection, if there is a good one. */
export function questionAt({ nextPosition, detection }: Timeline, names: readonly string[]): Question | undefined {
  const next = nextPosition === undefined ? undefined : detection.events[nextPosition - 1];
  if (!next) return undefined;
  const prunes = detection.events.some(({ kind }) => kind === "prune");
  return questionOf(next, detection.events[nextPosition!], prunes, names);
}

const NONE = 2 ** 32 - 1;

/**
 * The question about the event that comes next, if there is a good one. `after` is the event that
 * follows it in the trace; `prunes` says whether the algorithm ends scans early.
 */
function questionOf(next: TraceEvent, after: TraceEvent | undefined, prunes: boolean, names: readonly string[]): Question | undefined {
  const word = (name: string): number => Number(next[name]);
  const name = (ball: number): string => names[ball] ?? String(ball);
  const edge = (at: number): string => (at % 2 === 0 ? `(${name(at >> 1)}` : `${name(at >> 1)})`);
  switch (next.kind) {
    case "test":
      if (prunes) return tested(name(word("a")), name(word("b")), 0);
      return {
        text: `${name(word("a"))} and ${name(word("b"))} are tested next. Their boxes …`,
        choices: ["overlap", "are apart"],
        answer: word("left") === NONE ? 0 : 1,
      };
    case "prune":
      return tested(name(word("left")), name(word("right")), 1);
    case "compare":
      return {
        text: `${edge(word("a"))} is compared with ${edge(word("b"))}. They …`,
        choices: ["swap", "stay"],
        answer: after?.kind === "swap" ? 0 : 1,
      };
    case "enter":
    case "leave":
      return { text: "What does the line do next?", choices: ["enter a ball", "leave one"], answer: next.kind === "enter" ? 0 : 1 };
    default:
      return undefined;
  }
}

function tested(a: string, b: string, answer: 0 | 1): Question {
  return { text: `Next in order for ${a} comes ${b}. The pair is …`, choices: ["tested", "skipped"], answer };
}
