/** Resolves when the first of some elements is on the screen or about to be. */
export function whenNear(elements: Iterable<Element>, signal?: AbortSignal): Promise<void> {
  return new Promise((resolve) => {
    const observer = new IntersectionObserver(
      (entries) => {
        if (!entries.some(({ isIntersecting }) => isIntersecting)) return;
        observer.disconnect();
        resolve();
      },
      // The first demo of the article begins 275 px below a window of 1280 by 900 pixels: until it is scrolled, the demos' 193 KB (gzipped) are not loaded.
      { rootMargin: "150px" },
    );
    for (const element of elements) observer.observe(element);
    signal?.addEventListener("abort", () => observer.disconnect());
  });
}
