const ARROWS: Readonly<Record<string, readonly [x: number, y: number]>> = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };

/** Where an arrow key points, y down; nothing for any other key. */
export const arrowOf = ({ key }: KeyboardEvent): readonly [x: number, y: number] | undefined => ARROWS[key];
