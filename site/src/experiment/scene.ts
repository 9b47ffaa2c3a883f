/** The scene whose boxes are those of balls that fall. The others are compiled. */
export const FALLING = "falling balls";
