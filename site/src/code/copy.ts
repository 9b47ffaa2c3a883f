/** Lets the button of a listing copy its code. */
export function copyable(listing: HTMLElement): void {
  const button = listing.querySelector("[data-part=copy]");
  const code = listing.querySelector("code");
  button?.addEventListener("click", async () => {
    const copied = await navigator.clipboard.writeText(`${code?.textContent ?? ""}\n`).then(
      () => "Copied",
      () => "Not allowed",
    );
    button.textContent = copied;
    setTimeout(() => (button.textContent = "Copy"), 1500);
  });
}
