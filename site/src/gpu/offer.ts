import { showLoadFailure } from "../load-failed.ts";

/** Lets a button load `<gpu-boxes>`, of which nothing is loaded before, and begin where it stands in the page. */
export function offerGpu(button: HTMLButtonElement): void {
  button.disabled = false;
  const start = async (): Promise<void> => {
    try {
      const { GpuBoxes } = await import("./gpu-boxes.ts");
      customElements.define("gpu-boxes", GpuBoxes);
      document.querySelector<HTMLElement>("gpu-boxes [data-part=play]")?.focus();
      button.remove();
    } catch (error) {
      showLoadFailure(button.parentElement!, error);
    }
  };
  button.addEventListener("click", () => void start(), { once: true });
}
