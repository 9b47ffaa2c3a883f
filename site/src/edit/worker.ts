// The worker of the sandbox: runs a reader's code. It stands in a frame without origin, whose policy forbids all loading; what
// does not end is ended by the page, together with this worker.

import type { DemoProgram, ProgramEvent } from "sweep-and-prune-classroom/demo";
import { check, type Verdict } from "./checks.ts";
import { compiled, type Fault, faultOf } from "./compile.ts";
import { programOf } from "./harness.ts";

/** What a page asks: a detection by a changed listing, or whether a task is solved. */
export type Question =
  | { readonly kind: "run"; readonly listing: string; readonly code: string; readonly boxes?: Float64Array | undefined; readonly before?: Float64Array | undefined }
  | { readonly kind: "check"; readonly task: string; readonly code: string };

export type Answer = { readonly value: readonly ProgramEvent[] | Verdict } | { readonly fault: Fault };

/** The listings that run, as they were compiled. */
const running = new Map<string, { readonly code: string; readonly program: DemoProgram }>();

function answer(question: Question): readonly ProgramEvent[] | Verdict {
  if (question.kind === "check") return check(question.task, compiled(question.code));
  const { listing, code, boxes, before } = question;
  if (running.get(listing)?.code !== code) running.set(listing, { code, program: programOf(listing, compiled(code)) });
  // Without boxes the code is only compiled.
  return boxes ? (running.get(listing)!.program(boxes, before) as ProgramEvent[]) : [];
}

addEventListener("message", ({ ports: [port] }) => {
  port!.onmessage = ({ data }: MessageEvent<Question>) => {
    const say = (said: Answer): void => port!.postMessage(said);
    try {
      say({ value: answer(data) });
    } catch (error) {
      say({ fault: faultOf(error) });
    }
  };
  port!.postMessage("ready");
});
