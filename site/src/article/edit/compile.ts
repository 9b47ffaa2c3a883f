// Compiles a reader's code so that it cannot run for ever, and tells the line of an error.

import { javascriptLanguage } from "@codemirror/lang-javascript";
import type { Compile } from "./harness.ts";
import { messageOf } from "../../message-of.ts";
import { withLines } from "./lines.ts";

/** Loops and calls in one run, at most. */
const MOST = 200_000;

/** What is wrong with the code, and in which of its lines, if that is known. */
export class Fault extends Error {
  readonly line: number | undefined;

  constructor(message: string, line: number | undefined) {
    super(message);
    this.line = line;
  }
}

/** The code as a function of the names that it uses. `restart` allows it as many loops again. */
export function compiled(code: string): { compile: Compile; restart(): void } {
  let left = MOST;
  const tick = (): void => {
    if (--left < 0) throw new Error(`Stopped after ${MOST.toLocaleString("en")} loops and calls: does a loop never end?`);
  };
  const names = [...code.matchAll(/^export (?:function|const|let|class) (\w+)/gm)].map(([, name]) => name!);
  const declared = new Set([...code.matchAll(/^\s*(?:export )?(?:function|const|let|class) (\w+)/gm)].map(([, name]) => name!));
  const body = `"use strict"; ${withLines(guarded(code)).replace(/^export /gm, "")}\nreturn { ${names.join(", ")} };`;
  return {
    restart: () => (left = MOST),
    compile: (helpers) => {
      const given = Object.entries(helpers).filter(([name]) => !declared.has(name));
      try {
        return new Function("$tick", ...given.map(([name]) => name), body)(tick, ...given.map(([, value]) => value));
      } catch (error) {
        throw faultOf(error, code);
      }
    },
  };
}

/** The code with a count in each loop and function, on the same lines. */
function guarded(code: string): string {
  const inserts: [at: number, text: string][] = [];
  javascriptLanguage.parser.parse(code).iterate({
    enter({ name, node }) {
      const isLoop = /^(For|While|Do)Statement$/.test(name);
      if (!isLoop && !/^(Function(Declaration|Expression)|ArrowFunction|MethodDeclaration)$/.test(name)) return;
      const body = node.getChild("Block") ?? (isLoop ? node.lastChild : null);
      if (!body) return;
      if (body.name === "Block") inserts.push([body.from + 1, " $tick();"]);
      else inserts.push([body.from, "{ $tick(); "], [body.to, " }"]);
    },
  });
  // From the end on, so that the places before stay where they are.
  return inserts.sort(([a], [b]) => b - a).reduce((text, [at, insert]) => text.slice(0, at) + insert + text.slice(at), code);
}

/** An error of the code with its line: of the syntax as the parser finds it, of a run as the engine tells it. */
export function faultOf(error: unknown, code: string): Fault {
  if (error instanceof Fault) return error;
  const message = messageOf(error);
  return new Fault(message, error instanceof SyntaxError ? syntaxLine(code) : runLine(error));
}

function syntaxLine(code: string): number | undefined {
  let line: number | undefined;
  javascriptLanguage.parser.parse(code).iterate({
    enter({ type, from }) {
      if (type.isError) line ??= code.slice(0, from).split("\n").length;
    },
  });
  return line;
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

function runLine(error: unknown): number | undefined {
  const line = lineOf(error) - BEFORE;
  return line >= 1 ? line : undefined;
}
