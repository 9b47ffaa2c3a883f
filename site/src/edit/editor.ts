// A listing that a reader changes, in its place. Loaded when the first one is edited.

import { defaultKeymap, history, historyKeymap } from "@codemirror/commands";
import { javascriptLanguage } from "@codemirror/lang-javascript";
import { HighlightStyle, indentUnit, syntaxHighlighting } from "@codemirror/language";
import { EditorState, StateEffect, StateField } from "@codemirror/state";
import { Decoration, drawSelection, EditorView, keymap, lineNumbers } from "@codemirror/view";
import { tags } from "@lezer/highlight";
import { CodeError } from "./sandbox.ts";

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

/** An editor in the place of a listing. */
export interface Editor {
  /** Shows what there is to say of the code, the line of an error as well. */
  say(text: unknown): void;
  readonly code: string;
  readonly original: string;
  /** Shows the listing as it was. */
  close(): void;
}

/** Edits a listing; `changed` is called once, and whenever nothing has been typed for a moment. */
export function openEditor(listing: HTMLElement, label: string, changed: (code: string) => void): Editor {
  const shown = listing.querySelector("pre")!;
  const original = shown.textContent ?? "";
  const place = document.createElement("div");
  place.innerHTML = `<div class="editor"></div><p class="editor-said quiet" role="status"></p><button type="button" class="small">Original code</button>`;
  const [parent, said, again] = place.children as unknown as [Element, Element, Element];
  let timer: ReturnType<typeof setTimeout> | undefined;
  const run = (): void => changed(view.state.doc.toString());
  const view = new EditorView({
    parent,
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
        EditorView.contentAttributes.of({ "aria-label": label }),
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
  shown.after(place);
  const editor: Editor = {
    original,
    get code() {
      return view.state.doc.toString();
    },
    say: (text) => {
      const isFault = text instanceof Error;
      const { line, isSyntax } = text instanceof CodeError ? text.fault : {};
      const at = isSyntax ? syntaxLine(editor.code) : line;
      said.textContent = `${at === undefined ? "" : `Line ${at}: `}${isFault ? text.message : String(text)}`;
      said.toggleAttribute("data-fault", isFault);
      view.dispatch({ effects: setFault.of(at) });
    },
    close: () => {
      clearTimeout(timer);
      view.destroy();
      place.remove();
      shown.hidden = false;
    },
  };
  run();
  return editor;
}

/** The first line that is no program, as the parser of the editor finds it. */
function syntaxLine(code: string): number | undefined {
  let line: number | undefined;
  javascriptLanguage.parser.parse(code).iterate({
    enter({ type, from }) {
      if (type.isError) line ??= code.slice(0, from).split("\n").length;
    },
  });
  return line;
}
