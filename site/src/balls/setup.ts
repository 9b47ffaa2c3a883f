/** What the bodies of size 1 fill together: an area in 2D, a volume in 3D. The box is 10 wide. */
const FILLED = { 2: 32, 3: 335 } as const;

/** The middle radius of this many bodies. More bodies are smaller bodies: they fill the same space. */
export function radiusOf(bodies: number, dimensions: 2 | 3): number {
  const each = FILLED[dimensions] / bodies;
  return dimensions === 2 ? Math.sqrt(each / Math.PI) : Math.cbrt((3 * each) / (4 * Math.PI));
}
