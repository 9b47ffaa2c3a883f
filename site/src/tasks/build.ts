// Writes the tasks into their page, and their answers into the sheet for teachers, when the site is built.

import { highlight } from "../code/listing.ts";
import type { Tags } from "../shell/tags.ts";
import { TASKS, type Task } from "./tasks.ts";

function taskHtml({ name, title, asks, start, answer, explains }: Task, at: number): string {
  return `
    <section class="task" id="${name}" data-task="${name}" aria-labelledby="${name}-heading">
      <h2 id="${name}-heading">${at + 1}. ${title}</h2>
      <p>${asks}</p>
      <div class="listing">${highlight(start, "javascript", `the code of task ${at + 1}`)}</div>
      <button type="button" class="primary" data-part="try">Try it</button>
      <div class="verdict" role="status" hidden></div>
      <details class="ask">
        <summary>An answer</summary>
        <p>${explains}</p>
        ${highlight(answer, "javascript", `an answer to task ${at + 1}`)}
      </details>
    </section>`;
}

export const taskTags: Tags = {
  "code-tasks": () => TASKS.map(taskHtml).join(""),
  "task-answers": () => TASKS.map(({ name, title, asks, explains }) => `<dt><a href="./tasks.html#${name}">${title}</a>: ${asks}</dt><dd>${explains}</dd>`).join(""),
};
