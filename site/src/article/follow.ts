// Highlights the lines of a listing that match the current event of a demo. Readers can switch this
// off, for all listings at once; the choice is stored.

const KEY = "follow-demos";

export function followDemos(): void {
  const listings = [...document.querySelectorAll<HTMLElement>(".listing[data-follows]")];
  const buttons = listings.map((listing) => listing.querySelector<HTMLButtonElement>("[data-part=follow]"));
  let follows = stored();

  const show = (): void => {
    for (const button of buttons) button?.setAttribute("aria-pressed", String(follows));
    if (!follows) for (const listing of listings) light(listing, undefined);
  };
  show();
  for (const button of buttons) {
    button?.addEventListener("click", () => {
      follows = !follows;
      store(follows);
      show();
    });
  }
  for (const listing of listings) {
    const demo = document.querySelector(`#${listing.dataset["follows"]} sap-demo`);
    demo?.addEventListener("sap-event", (event) => {
      if (follows) light(listing, (event as CustomEvent<{ kind: string }>).detail.kind);
    });
  }
}

function light(listing: HTMLElement, kind: string | undefined): void {
  for (const line of listing.querySelectorAll<HTMLElement>("[data-kinds]")) {
    const kinds = line.dataset["kinds"]?.split(" ") ?? [];
    line.classList.toggle("at-work", kind !== undefined && kinds.includes(kind));
  }
}

function stored(): boolean {
  try {
    return localStorage.getItem(KEY) !== "off";
  } catch {
    return true;
  }
}

function store(follows: boolean): void {
  try {
    if (follows) localStorage.removeItem(KEY);
    else localStorage.setItem(KEY, "off");
  } catch {
    // Without storage the choice lasts as long as the page.
  }
}
