// The order in which the demos of a page begin: those that a reader sees at once, each of the others in a task of its
// own. Thirty demos that begin in one task would keep a phone from showing the first one for seconds.

/** What waits for the turn of an element. */
const waiting = new Map<Element, (() => void)[]>();
let timer: ReturnType<typeof setTimeout> | undefined;
let observer: IntersectionObserver | undefined;

/** Resolves when an element has its turn. */
export function turnOf(element: Element): Promise<void> {
  // Where nothing is drawn, the browser does not tell what is in view.
  if (document.hidden) return Promise.resolve();
  observer ??= new IntersectionObserver(see, { rootMargin: "50px" });
  return new Promise((resolve) => {
    waiting.set(element, [...(waiting.get(element) ?? []), resolve]);
    observer!.observe(element);
  });
}

function see(entries: IntersectionObserverEntry[]): void {
  for (const { target, isIntersecting } of entries) if (isIntersecting) start(target);
  timer ??= setTimeout(next);
}

function start(element: Element): void {
  observer!.unobserve(element);
  const all = waiting.get(element) ?? [];
  waiting.delete(element);
  for (const go of all) go();
}

function next(): void {
  timer = undefined;
  const first = waiting.keys().next().value;
  if (!first) return;
  start(first);
  timer = setTimeout(next);
}
