/** The scene whose boxes are those of balls that fall. The others are compiled. */
export const FALLING = "falling balls";

/** How they move, in units a second squared: the box is 10 wide. */
export const GRAVITIES: Readonly<Record<string, number>> = { "on Earth": 9.81, "on the Moon": 1.62 };
