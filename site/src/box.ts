/** A box of the plane, the second axis down, as listings and figures have it. */
export interface Box {
  readonly id: number;
  left: number;
  top: number;
  right: number;
  bottom: number;
}
