// A listing that a reader changes, and the demo that runs it. Loaded when the first listing is edited.

import { defaultKeymap, history, historyKeymap } from "@codemirror/commands";
import { javascriptLanguage } from "@codemirror/lang-javascript";
import { HighlightStyle, indentUnit, syntaxHighlighting } from "@codemirror/language";
import { EditorState, StateEffect, StateField } from "@codemirror/state";
import { Decoration, drawSelection, EditorView, keymap, lineNumbers } from "@codemirror/view";
import { tags } from "@lezer/highlight";
import type { SapDemo } from "sweep-and-prune-classroom/demo";
import { compiled, type Fault, faultOf } from "./compile.ts";
import { programOf } from "./harness.ts";

/** A change runs when nothing was typed for this long. */
const PAUSE_MS = 400;

/** The colors of the listings. */
const colors = HighlightStyle.define([
  { tag: [tags.keyword, tags.operatorKeyword], color: "var(--code-token-keyword)" },
  { tag: [tags.function(tags.variableName), tags.function(tags.propertyName)], color: "var(--code-token-function)" },
  { tag: [tags.number, tags.bool, tags.null], color: "var(--code-token-constant)" },
  { tag: tags.string, color: "var(--code-token-string)" },
  { tag: tags.comment, color: "var(--code-token-comment)" },
]);

const setFault = StateEffect.define<number | undefined>();

/** The line of the last error. */
const faultLine = StateField.define({
  create: () => Decoration.none,
  update(marked, { effects, docChanged, state }) {
    for (const effect of effects) {
      if (!effect.is(setFault)) continue;
      const line = effect.value;
      if (line === undefined || line > state.doc.lines) return Decoration.none;
      return Decoration.set([Decoration.line({ class: "at-fault" }).range(state.doc.line(line).from)]);
    }
    return docChanged ? Decoration.none : marked;
  },
  provide: (field) => EditorView.decorations.from(field),
});

/** Shows an editor in the place of a listing; its demo runs what is in it. Returns what ends that. */
export function edit(listing: HTMLElement, demo: SapDemo): () => void {
  const shown = listing.querySelector("pre")!;
  const name = listing.dataset["listing"]!;
  const original = shown.textContent ?? "";
  const place = document.createElement("div");
  place.className = "editor";
  const said = document.createElement("p");
  said.className = "editor-said";
  said.setAttribute("role", "status");
  const again = document.createElement("button");
  again.type = "button";
  again.className = "small";
  again.textContent = "Original code";
  /** What the demo runs when nothing is edited. */
  const before = demo.program;
  let timer: ReturnType<typeof setTimeout> | undefined;

  const say = (text: string, fault?: Fault): void => {
    said.textContent = text;
    said.toggleAttribute("data-fault", fault !== undefined);
    view.dispatch({ effects: setFault.of(fault?.line) });
  };
  const fail = (error: unknown, code: string): void => {
    const fault = faultOf(error, code);
    say(`${fault.line === undefined ? "" : `Line ${fault.line}: `}${fault.message}`, fault);
  };
  const run = (): void => {
    const code = view.state.doc.toString();
    try {
      const { compile, restart } = compiled(code);
      const program = programOf(name, compile);
      let hasFailed = false;
      say(code === original ? "The demo runs this code. Change it." : "The demo runs your code.");
      demo.program = (boxes, before) => {
        restart();
        try {
          return program(boxes, before);
        } catch (error) {
          // Said once, however often the demo asks; what it finds then is nothing.
          if (!hasFailed) queueMicrotask(() => fail(error, code));
          hasFailed = true;
          return [];
        }
      };
    } catch (error) {
      fail(error, code);
    }
  };

  const view = new EditorView({
    parent: place,
    state: EditorState.create({
      doc: original,
      extensions: [
        lineNumbers(),
        history(),
        drawSelection(),
        indentUnit.of("  "),
        javascriptLanguage,
        syntaxHighlighting(colors),
        faultLine,
        // Tab leaves the editor, as it leaves any other control.
        keymap.of([{ key: "Mod-Enter", run: () => (run(), true) }, ...defaultKeymap, ...historyKeymap]),
        EditorView.contentAttributes.of({ "aria-label": `Code of ${name}.js: the demo runs it` }),
        EditorView.updateListener.of(({ docChanged }) => {
          if (!docChanged) return;
          clearTimeout(timer);
          timer = setTimeout(run, PAUSE_MS);
        }),
      ],
    }),
  });
  again.addEventListener("click", () => view.dispatch({ changes: { from: 0, to: view.state.doc.length, insert: original } }));
  shown.hidden = true;
  shown.after(place, said, again);
  view.focus();
  run();
  return () => {
    clearTimeout(timer);
    demo.program = before;
    view.destroy();
    for (const part of [place, said, again]) part.remove();
    shown.hidden = false;
  };
}
