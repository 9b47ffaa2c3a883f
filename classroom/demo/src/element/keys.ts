import type { Options } from "./options.js";

/** How far an arrow key moves a ball, and with shift. */
const ARROW = 5;
const FAR_ARROW = 25;

/** What keys do. */
export interface Keyboard {
  playOrPause(): void;
  step(): void;
  back(): void;
  /** To the next ball, or to the one before. */
  moveCursor(by: 1 | -1): void;
  /** Takes the ball at the cursor for an explanation. */
  take(): void;
  takeNone(): void;
  /** Moves the ball at the cursor by hand. */
  push(dx: number, dy: number): void;
  guess(choice: number): void;
}

/** Does what a key is for, if it is for anything. */
export function press(event: KeyboardEvent, { isDraggable }: Options, keyboard: Keyboard): void {
  if (event.altKey || event.ctrlKey || event.metaKey) return;
  if (event.key.startsWith("Arrow") && !isDraggable) return;
  const by = event.shiftKey ? FAR_ARROW : ARROW;
  const actions: Record<string, () => void> = {
    " ": () => keyboard.playOrPause(),
    "[": () => keyboard.back(),
    ",": () => keyboard.back(),
    "]": () => keyboard.step(),
    ".": () => keyboard.step(),
    b: () => keyboard.moveCursor(1),
    B: () => keyboard.moveCursor(-1),
    Enter: () => keyboard.take(),
    Escape: () => keyboard.takeNone(),
    ArrowLeft: () => keyboard.push(-by, 0),
    ArrowRight: () => keyboard.push(by, 0),
    ArrowUp: () => keyboard.push(0, -by),
    ArrowDown: () => keyboard.push(0, by),
    1: () => keyboard.guess(0),
    2: () => keyboard.guess(1),
    3: () => keyboard.guess(2),
  };
  const action = actions[event.key];
  if (!action) return;
  event.preventDefault();
  action();
}

/** The keys in words, for screen readers. */
export function keysOf(options: Options | undefined, canPlay: boolean): string {
  const keys = canPlay ? ["Space plays or pauses.", "Comma and full stop step back and forward."] : [];
  if (options?.isDraggable || options?.explains) keys.push("B chooses the next ball.");
  if (options?.isDraggable) keys.push("Arrow keys move it.");
  if (options?.explains) keys.push("Enter selects it; select two to see why they were tested or skipped.");
  if (options?.predicts) keys.push("1, 2 and 3 guess.");
  return keys.join(" ");
}
