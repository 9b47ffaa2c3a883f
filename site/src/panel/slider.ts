// A slider over a list of values that need not be evenly spaced.

/** A slider that is being dragged is heard at most this often. */
const DRAG_MS = 100;

interface SliderOptions {
  readonly slider: HTMLInputElement;
  /** Shows the value as text. */
  readonly output: HTMLElement;
  readonly values: readonly number[];
  readonly value: number;
  readonly format: (value: number) => string;
  /** Called with the value that was chosen; while it is dragged, now and then. */
  readonly changed: (value: number) => void;
}

export function bindSlider({ slider, output, values, value, format, changed }: SliderOptions): void {
  slider.min = "0";
  slider.max = String(values.length - 1);
  slider.value = String(nearest(values, value));
  const show = (value: number): void => {
    const text = format(value);
    output.textContent = text;
    slider.setAttribute("aria-valuetext", text);
  };
  show(value);
  let timer: ReturnType<typeof setTimeout> | undefined;
  slider.addEventListener("input", () => {
    show(values[slider.valueAsNumber] ?? value);
    timer ??= setTimeout(() => {
      timer = undefined;
      changed(values[slider.valueAsNumber] ?? value);
    }, DRAG_MS);
  });
}

/** The position of the value nearest to `target`. */
function nearest(values: readonly number[], target: number): number {
  return values.reduce((best, value, i) => (Math.abs(value - target) < Math.abs((values[best] ?? 0) - target) ? i : best), 0);
}
