/**
 * The context of a canvas, which is made as fine as the screen shows it: scaled to so many units
 * across, or to CSS pixels. None while it is not shown.
 */
export function canvasContext(canvas: Element | null, units?: number): CanvasRenderingContext2D | undefined {
  if (!(canvas instanceof HTMLCanvasElement) || canvas.clientWidth === 0) return undefined;
  const context = canvas.getContext("2d");
  if (!context) return undefined;
  const ratio = Math.min(devicePixelRatio, 3);
  const width = Math.round(canvas.clientWidth * ratio);
  const height = Math.round(canvas.clientHeight * ratio);
  if (canvas.width !== width || canvas.height !== height) [canvas.width, canvas.height] = [width, height];
  const scale = units === undefined ? ratio : width / units;
  context.setTransform(scale, 0, 0, scale, 0, 0);
  return context;
}
