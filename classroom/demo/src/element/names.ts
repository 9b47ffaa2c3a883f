/** Names of the balls: those given, otherwise letters, and numbers after Z. */
export function namesOf(labels: readonly string[] | "emoji" | undefined, count: number): string[] {
  const given = labels === "emoji" ? emoji : (labels ?? []);
  return Array.from({ length: count }, (_, ball) => {
    if (labels === "emoji") return emoji[ball % emoji.length]!;
    return given[ball] || (count <= 26 ? String.fromCharCode(65 + ball) : String(ball));
  });
}

// prettier-ignore
const emoji = [
  "🎾", "🏀", "⚽", "🏐", "🎱", "🌍", "🍊", "🍉", "🌝", "🍪", "🥥", "🍎", "🌸",
  "🎈", "🧶", "🐡", "🥎", "🏈", "🪩", "🫧", "🍇", "🦔", "🐞", "🌻", "🥚", "🎃", "🐥", "🪐", "🍋", "🧿",
];
