import type { Each, Engine, Exports } from "../wasm/engine.js";

/** How much of Rust's own stack a call needs at most, in bytes: all calls take less than half of it (js/test/boundary.test.js). */
const stackForCall = 128 * 1024;

/**
 * Makes a call that hands pairs to `each`, and returns its code. What `each` throws cancels the search, and is thrown
 * from here, after the call returned: an exception must not skip Rust's frames. Within `each`
 * other calls are allowed.
 */
export function streamPairs(engine: Engine<Exports>, call: () => number, each: Each): number {
  const outer = engine.each;
  let thrown: { error: unknown } | undefined;
  engine.each = (at, count) => {
    const { stackTop } = engine;
    let top = 0;
    try {
      // Calls within `each` leave the frames of this call where they are, also if they throw.
      top = engine.stackTop = engine.exports.__stack_pointer.value;
      if (top < stackForCall) throw new RangeError("too much recursion: searches within callbacks of searches");
      return each(at, count);
    } catch (error) {
      thrown = { error };
      return false;
    } finally {
      engine.stackTop = stackTop;
      engine.isStackLeft = true;
      if (top !== 0) engine.exports.__stack_pointer.value = top;
    }
  };
  try {
    const code = call();
    if (thrown) throw thrown.error;
    return code;
  } finally {
    engine.each = outer;
  }
}
