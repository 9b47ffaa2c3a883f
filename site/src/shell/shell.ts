// What the frame of every page does.

import { choice, choose, onThemeChange, type Choice } from "./theme.ts";

const select = document.querySelector<HTMLSelectElement>("#theme");
if (select) {
  const show = (): void => {
    select.value = choice();
  };
  show();
  onThemeChange(show);
  select.addEventListener("change", () => choose(select.value as Choice));
}
