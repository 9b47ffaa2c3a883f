// The code beside the three balls: what the tests say as they are dragged, and whether the third is
// needed at all.

/** A ball on the axis. */
interface Interval {
  readonly left: number;
  readonly right: number;
}

/** The demo's element, as far as it is needed here. */
type Demo = Element & { balls: readonly (readonly number[])[] };

/** What to say of three intervals. */
export interface Verdict {
  /** Whether A ends before B begins, and B before C. */
  readonly ab: boolean;
  readonly bc: boolean;
  /** Whether A ends before C begins. */
  readonly ac: boolean;
  /** Whether that follows from the other two. */
  readonly skipped: boolean;
  readonly why: string;
}

export function judge(a: Interval, b: Interval, c: Interval): Verdict {
  const [ab, bc, ac] = [a.right < b.left, b.right < c.left, a.right < c.left];
  const skipped = ab && bc;
  return { ab, bc, ac, skipped, why: reason(ab, bc) };
}

function reason(ab: boolean, bc: boolean): string {
  if (ab && bc) return "A ends before B begins, and B before C. So A ends before C begins: nothing has to be tested.";
  if (ab) return "There is a gap between A and B, but none between B and C in this order. Nothing follows for A and C: they must be tested.";
  if (bc) return "There is a gap between B and C, but none between A and B in this order. Nothing follows for A and C: they must be tested.";
  return "There is no gap in this order. Nothing follows for A and C, whatever it looks like: they must be tested.";
}

export class TransitivityCode extends HTMLElement {
  connectedCallback(): void {
    const demo = document.querySelector<Demo>(`#${this.getAttribute("for")} sap-demo`);
    const update = (): void => {
      if (demo?.balls?.length === 3) this.#show(demo.balls.map(([x = 0, , radius = 0]) => ({ left: x - radius, right: x + radius })));
    };
    for (const event of ["simulate", "sap-drag"]) demo?.addEventListener(event, update);
  }

  #show([a, b, c]: readonly Interval[]): void {
    if (!a || !b || !c) return;
    const { ab, bc, ac, skipped, why } = judge(a, b, c);
    this.#set("ab", line("A", a, "B", b, ab));
    this.#set("bc", line("B", b, "C", c, bc));
    this.#set("ac", skipped ? "// A and C: skipped" : line("A", a, "C", c, ac));
    this.#set("why", why);
  }

  #set(part: string, text: string): void {
    const element = this.querySelector(`[data-part=${part}]`);
    // Unchanged text is left alone: it would be read out again.
    if (element && element.textContent !== text) element.textContent = text;
  }
}

function line(one: string, { right }: Interval, other: string, { left }: Interval, holds: boolean): string {
  return `${one}.right < ${other}.left  // ${Math.round(right)} < ${Math.round(left)}: ${holds ? "true, apart" : "false"}`;
}
