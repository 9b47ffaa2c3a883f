// What a visitor has chosen, from page to page. Without storage a choice lasts as long as the page.

export function stored(key: string): string | null {
  try {
    return localStorage.getItem(key);
  } catch {
    return null;
  }
}

/** Stores a choice; `undefined`, what holds without a choice, is forgotten. */
export function store(key: string, choice: string | undefined): void {
  try {
    if (choice === undefined) localStorage.removeItem(key);
    else localStorage.setItem(key, choice);
  } catch {
    // There is no storage here.
  }
}
