// A listing of the article that a reader changes, and the demo that runs it. Loaded when the first listing is edited.

import type { ProgramEvent, SapDemo } from "sweep-and-prune-classroom/demo";
import { type Editor, openEditor } from "../edit/editor.ts";
import { Sandbox } from "../edit/sandbox.ts";

/** One for all listings, kept when an editor is closed. */
const sandbox = new Sandbox();

/** Shows an editor in the place of a listing; its demo runs what is in it. Returns what ends that. */
export function edit(listing: HTMLElement, demo: SapDemo): () => void {
  const name = listing.dataset["listing"]!;
  /** What the demo runs when nothing is edited. */
  const before = demo.program;
  let editor: Editor | undefined;

  const run = (code: string): void => {
    let hasFailed = false;
    // Said once, however often the demo asks.
    const fail = (error: unknown): readonly ProgramEvent[] => {
      if (!hasFailed && editor?.code === code) editor.say(error);
      hasFailed = true;
      return [];
    };
    sandbox.ask({ kind: "run", listing: name, code }).then(
      () => {
        if (editor?.code !== code) return;
        editor.say(code === editor.original ? "The demo runs this code. Change it." : "The demo runs your code.");
        // What fails finds nothing, and is not run again: it might take as long each time.
        demo.program = (boxes, before) => (hasFailed ? [] : sandbox.ask({ kind: "run", listing: name, code, boxes, before }).catch(fail));
      },
      fail,
    );
  };
  editor = openEditor(listing, `Code of ${name}.js: the demo runs it`, (code) => queueMicrotask(() => run(code)));
  listing.querySelector<HTMLElement>(".cm-content")!.focus();
  return () => {
    demo.program = before;
    editor.close();
  };
}
