// The five tasks: what a reader writes is checked by running it. The editor is loaded when the first task is tried.

import type { Verdict } from "../edit/checks.ts";
import type { Editor } from "../edit/editor.ts";
import type { Sandbox } from "../edit/sandbox.ts";
import { showLoadFailureAfter } from "../load-failed.ts";
import { letter, line, rect, text } from "../svg.ts";

let sandbox: Sandbox | undefined;

for (const task of document.querySelectorAll<HTMLElement>(".task")) {
  const button = task.querySelector<HTMLButtonElement>("[data-part=try]")!;
  button.addEventListener("click", async () => {
    button.disabled = true;
    try {
      const [{ openEditor }, { Sandbox }] = await Promise.all([import("../edit/editor.ts"), import("../edit/sandbox.ts")]);
      sandbox ??= new Sandbox();
      start(task, openEditor, sandbox);
      button.remove();
      task.querySelector<HTMLElement>(".cm-content")?.focus();
    } catch (error) {
      button.disabled = false;
      showLoadFailureAfter(button, error);
    }
  });
}

function start(task: HTMLElement, openEditor: typeof import("../edit/editor.ts").openEditor, sandbox: Sandbox): void {
  const verdict = task.querySelector<HTMLElement>(".verdict")!;
  let editor: Editor | undefined;
  const check = async (code: string): Promise<void> => {
    try {
      const found = await sandbox.ask({ kind: "check", task: task.dataset["task"]!, code });
      if (editor?.code !== code) return;
      editor.say("");
      show(verdict, found);
    } catch (error) {
      if (editor?.code !== code) return;
      editor.say(error);
      verdict.hidden = true;
    }
  };
  editor = openEditor(task.querySelector<HTMLElement>(".listing")!, `Your code for: ${task.querySelector("h2")!.textContent}`, (code) => queueMicrotask(() => check(code)));
}

function show(place: HTMLElement, { isSolved, says, boxes, pair }: Verdict): void {
  place.hidden = false;
  place.toggleAttribute("data-solved", isSolved);
  const words = document.createElement("p");
  words.innerHTML = `<strong>${isSolved ? "Solved." : "Not yet."}</strong> `;
  words.append(says);
  place.replaceChildren(words);
  if (boxes) place.insertAdjacentHTML("beforeend", picture(boxes, pair));
}

/** The boxes with their names, the pair joined by a dotted line: it is missed, or it should not be there. */
function picture(boxes: NonNullable<Verdict["boxes"]>, pair: Verdict["pair"]): string {
  const [left, top] = [Math.min(...boxes.map((box) => box.left)), Math.min(...boxes.map((box) => box.top))];
  const [right, bottom] = [Math.max(...boxes.map((box) => box.right)), Math.max(...boxes.map((box) => box.bottom))];
  const scale = Math.min(560 / Math.max(right - left, 1), 240 / Math.max(bottom - top, 1));
  const x = (at: number): number => 8 + scale * (at - left);
  const y = (at: number): number => 8 + scale * (at - top);
  const center = (id: number): [number, number] => [x((boxes[id]!.left + boxes[id]!.right) / 2), y((boxes[id]!.top + boxes[id]!.bottom) / 2)];
  const shown = boxes.map((box) => {
    const [cx, cy] = center(box.id);
    return rect({ left: x(box.left), top: y(box.top), right: x(box.right), bottom: y(box.bottom) }, "box") + (box.id < 26 ? text(cx, cy + 5, letter(box.id)) : "");
  });
  const joined = pair ? line(...center(pair[0].id), ...center(pair[1].id), "pair") : "";
  const [width, height] = [x(right) + 8, y(bottom) + 8];
  return `<svg viewBox="0 0 ${width} ${height}" width="${width}" height="${height}" role="img" aria-label="The boxes in which that shows">${shown.join("")}${joined}</svg>`;
}
