import type { Each, Engine, Exports, Passed } from "./engine.js";

/**
 * Makes a call that hands pairs to `each`. What `each` throws cancels the search, and is thrown
 * from here, after the call returned: an exception must not skip Rust's frames. Within `each`
 * other calls are allowed.
 */
export function streamPairs(engine: Engine<Exports>, call: () => number, each: Each, passed: Passed): void {
  const outer = engine.each;
  let thrown: { error: unknown } | undefined;
  engine.each = (at, count) => {
    // If a call within `each` fails, the frames of this call must stay where they are.
    const stackTop = engine.stackTop;
    engine.stackTop = engine.exports.__stack_pointer.value;
    try {
      return each(at, count);
    } catch (error) {
      thrown = { error };
      return false;
    } finally {
      engine.stackTop = stackTop;
    }
  };
  try {
    const code = call();
    if (thrown) throw thrown.error;
    engine.check(code, passed);
  } finally {
    engine.each = outer;
  }
}
