// The code beside the three balls: the results of the tests as the balls are dragged, and whether the
// third test is needed at all.

/** The interval of a ball on the axis. */
interface Interval {
  readonly left: number;
  readonly right: number;
}

/** What this file needs of the demo's element. */
type Demo = Element & { balls: readonly (readonly number[])[] };

/** Whether the third test is needed, if A ends before B begins or not, and B before C or not. */
function reason(ab: boolean, bc: boolean): string {
  if (ab && bc) return "A ends before B begins, and B ends before C begins. So A ends before C begins: we can skip the third test.";
  if (ab) return "A ends before B begins, but B does not end before C begins. So we know nothing about A and C: they must be tested.";
  if (bc) return "B ends before C begins, but A does not end before B begins. So we know nothing about A and C: they must be tested.";
  return "Neither comparison is true. So we know nothing about A and C: they must be tested.";
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
    const [ab, bc] = [a.right < b.left, b.right < c.left];
    this.#set("ab", line("A", a, "B", b));
    this.#set("bc", line("B", b, "C", c));
    this.#set("ac", ab && bc ? "// A and C: skipped" : line("A", a, "C", c));
    this.#set("why", reason(ab, bc));
  }

  #set(part: string, text: string): void {
    const element = this.querySelector(`[data-part=${part}]`);
    // A screen reader would read unchanged text again if it were set again.
    if (element && element.textContent !== text) element.textContent = text;
  }
}

function line(one: string, { right }: Interval, other: string, { left }: Interval): string {
  return `${one}.right < ${other}.left // ${right < left}: ${Math.round(right)} < ${Math.round(left)}`;
}
