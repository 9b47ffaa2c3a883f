/**
 * A canvas that is as fine as the screen shows it. Its size is asked for only when it changes:
 * to ask in each frame would make the browser lay out the page each time.
 */
class Sized {
  readonly #canvas: HTMLCanvasElement;
  readonly #context: CanvasRenderingContext2D | null;
  width = 0;
  height = 0;

  constructor(canvas: HTMLCanvasElement) {
    this.#canvas = canvas;
    this.#context = canvas.getContext("2d");
    this.measure();
  }

  measure(): void {
    this.width = this.#canvas.clientWidth;
    this.height = this.#canvas.clientHeight;
  }

  /** The context, scaled to `units` across or to CSS pixels; undefined while the canvas is not shown. */
  context(units: number | undefined): CanvasRenderingContext2D | undefined {
    if (!this.#context || this.width === 0) return undefined;
    const ratio = Math.min(devicePixelRatio, 3);
    const [width, height] = [Math.round(this.width * ratio), Math.round(this.height * ratio)];
    if (this.#canvas.width !== width) this.#canvas.width = width;
    if (this.#canvas.height !== height) this.#canvas.height = height;
    const scale = units === undefined ? ratio : width / units;
    this.#context.setTransform(scale, 0, 0, scale, 0, 0);
    return this.#context;
  }
}

/** The canvases of one element. */
export class Canvases {
  readonly #sized = new Map<HTMLCanvasElement, Sized>();
  readonly #observer: ResizeObserver;

  /** `resized` is called when one has another size than it was drawn for. */
  constructor(resized: () => void) {
    this.#observer = new ResizeObserver((entries) => {
      for (const { target } of entries) this.#sized.get(target as HTMLCanvasElement)?.measure();
      resized();
    });
  }

  /** The context to draw by, and the width in CSS pixels. */
  open(canvas: HTMLCanvasElement | null, units?: number): { context: CanvasRenderingContext2D; width: number } | undefined {
    if (!canvas) return undefined;
    let sized = this.#sized.get(canvas);
    if (!sized) {
      this.#sized.set(canvas, (sized = new Sized(canvas)));
      this.#observer.observe(canvas);
    }
    const context = sized.context(units);
    return context && { context, width: sized.width };
  }

  /** Forgets all sizes. Each is measured again when its demo opens again. */
  close(): void {
    this.#observer.disconnect();
    this.#sized.clear();
  }
}
