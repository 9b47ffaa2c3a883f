// Compiles a reader's code, in the worker of the sandbox.

import type { Compile } from "./harness.ts";
import { withLines } from "./lines.ts";
import { messageOf } from "../message-of.ts";

/** What is wrong with the code, and in which of its lines, if that is known. */
export interface Fault {
  readonly message: string;
  readonly line: number | undefined;
  /** Whether it is no program at all: the engine does not tell the line of that. */
  readonly isSyntax: boolean;
}

/** The code as a function of the names that it uses. */
export function compiled(code: string): Compile {
  const names = [...code.matchAll(/^export (?:function|const|let|class) (\w+)/gm)].map(([, name]) => name!);
  const declared = new Set([...code.matchAll(/^\s*(?:export )?(?:function|const|let|class) (\w+)/gm)].map(([, name]) => name!));
  const body = `"use strict"; ${withLines(code).replace(/^export /gm, "")}\nreturn { ${names.join(", ")} };`;
  return (helpers) => {
    const given = Object.entries(helpers).filter(([name]) => !declared.has(name));
    return new Function(...given.map(([name]) => name), body)(...given.map(([, value]) => value));
  };
}

/** An error of the code with its line, as the engine tells it. */
export function faultOf(error: unknown): Fault {
  const line = lineOf(error) - BEFORE;
  return { message: messageOf(error), line: line >= 1 ? line : undefined, isSyntax: error instanceof SyntaxError };
}

/** The lines that an engine puts before the body of a function made from text. */
const BEFORE = lineOf(probe()) - 1;

function probe(): unknown {
  try {
    return new Function("a", "throw new Error()")(0);
  } catch (error) {
    return error;
  }
}

function lineOf(error: unknown): number {
  const stack = error instanceof Error ? (error.stack ?? "") : "";
  return Number(/(?:<anonymous>|Function):(\d+):\d+\)?$/m.exec(stack)?.[1] ?? Number.NaN);
}
