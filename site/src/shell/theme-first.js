// Runs before the first picture: which palette holds, by choice or by the system.
{
  let chosen = null;
  try {
    chosen = localStorage.getItem("theme");
  } catch {
    // Without storage the choice lasts as long as the page.
  }
  const root = document.documentElement;
  root.classList.add("scripted");
  if (chosen === "light" || chosen === "dark") root.dataset.theme = chosen;
}
